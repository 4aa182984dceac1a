// Verification of what a laboratory does: loads on parts, motion from the start, waves that meet.
#pragma once

#include "src/verification/cases.h"

namespace ligament::program
{
std::vector<Case> lab_cases();
std::vector<Case> lab_hertz_cases();
std::vector<Case> lab_kirsch_cases();
std::vector<Case> lab_oblique_cases();
std::vector<Case> lab_periodic_cases();
std::vector<Case> lab_ring_cases();
std::vector<Case> lab_shapes_cases();
} // namespace ligament::program
