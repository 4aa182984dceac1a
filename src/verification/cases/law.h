// Laws of fracture: strengths of homogeneous bodies, and where cracks run, by criterion.
#pragma once

#include "src/verification/cases.h"

namespace ligament::program
{
std::vector<Case> law_cases();
} // namespace ligament::program
