// Energy balance of bodies that break off the rows.
#pragma once

#include "src/verification/cases.h"

namespace ligament::program
{
std::vector<Case> breaking_cases();
} // namespace ligament::program
