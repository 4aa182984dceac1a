// Small sets of combinations in which any two settings meet: pairwise covering.
#pragma once

#include <vector>

namespace ligament::program
{
/// Rows of levels, one per factor: for any two factors every pair of their levels stands in some
/// row. `levels` is the number of levels of each factor. Greedy, hence not the smallest set, and
/// the same every time.
std::vector<std::vector<int>> covering_set(const std::vector<int> &levels);
} // namespace ligament::program
