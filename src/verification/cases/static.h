// Cases of loading without steps.
#pragma once

#include "src/verification/cases.h"

namespace ligament::program
{
std::vector<Case> static_cases();
std::vector<Case> static_run_cases();
} // namespace ligament::program
