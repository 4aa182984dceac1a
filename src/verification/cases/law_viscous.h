// Laws of viscosity: relaxation and creep of bodies against closed forms.
#pragma once

#include "src/verification/cases.h"

namespace ligament::program
{
std::vector<Case> law_viscous_cases();
} // namespace ligament::program
