// Verification of far fields whose cells are no boxes.
#pragma once

#include "src/verification/cases.h"

namespace ligament::program
{
std::vector<Case> lab_general_cells_cases();
} // namespace ligament::program
