// What becomes of faces: bonded again, and crossed by cracks of limited velocity.
#pragma once

#include "src/verification/cases.h"

namespace ligament::program
{
std::vector<Case> face_life_cases();
} // namespace ligament::program
