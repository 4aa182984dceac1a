// Stability under stress: which cases belong to it.
#pragma once

#include "src/verification/cases.h"

namespace ligament::program
{
/// Shapes and loads at the edge of what the set-up accepts.
std::vector<Case> stress_cases();

/// `verify --stability`: the covering set, the stress cases and the free spinning bodies; with
/// `full` also the long runs.
std::vector<Case> select_stability(bool full);
} // namespace ligament::program
