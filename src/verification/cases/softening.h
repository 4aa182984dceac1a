// Faces that soften: the energy that a crack takes, and how much notched beams bear.
#pragma once

#include "src/verification/cases.h"

namespace ligament::program
{
std::vector<Case> softening_cases();
} // namespace ligament::program
