// A face that softens in a bar that relaxes or flows, against closed forms.
#pragma once

#include "src/verification/cases.h"

namespace ligament::program
{
std::vector<Case> softening_flow_cases();
} // namespace ligament::program
