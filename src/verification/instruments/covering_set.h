// Small sets of combinations in which any two settings meet: pairwise covering.
#pragma once

#include <array>
#include <functional>
#include <vector>

namespace ligament::program
{
/// Rows of levels, one per factor: for any two factors every pair of their levels stands in some
/// row. `levels` is the number of levels of each factor. Greedy, hence not the smallest set, and
/// the same every time.
struct CoveringSet
{
  std::vector<std::vector<int>> rows; // those that were accepted
  std::vector<std::array<int, 4>>
      given_up; // pairs that no row carried: factor, level, factor, level
};

/// A row counts when `accepts` says so. The pair that a refused row was made for is tried again
/// among the levels of rows that were accepted; after `n_tries` rows it is given up.
CoveringSet covering_set(const std::vector<int> &levels,
                         const std::function<bool(const std::vector<int> &)> &accepts,
                         int n_tries = 4);
} // namespace ligament::program
