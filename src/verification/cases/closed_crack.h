// Wing cracks at a closed crack against linear elastic fracture mechanics.
#pragma once

#include "src/verification/cases.h"

namespace ligament::program
{
std::vector<Case> closed_crack_cases();
} // namespace ligament::program
