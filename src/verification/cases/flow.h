// Laws of flow: bars in tension, triaxial compression, the balance of energy.
#pragma once

#include "src/verification/cases.h"

namespace ligament::program
{
/// A bar with free sides under von Mises' flow.
std::vector<Case> flow_strip_cases();
/// Drucker and Prager's cone under confinement, and at its apex.
std::vector<Case> flow_cone_cases();
/// Bodies in free flight that flow.
std::vector<Case> flow_balance_cases();
} // namespace ligament::program
