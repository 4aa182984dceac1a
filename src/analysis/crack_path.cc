#include "src/analysis/crack_path.h"

#include <algorithm>
#include <cmath>

namespace ligament::program
{
std::vector<double> nearest_distances(const std::vector<BrokenBond> &from,
                                      const std::vector<BrokenBond> &to)
{
  if (to.empty())
    return {};
  // Sorted along x: the search goes both ways until x alone is farther than the best so far.
  std::vector<const BrokenBond *> sorted;
  for (const auto &bond : to)
    sorted.push_back(&bond);
  std::sort(sorted.begin(), sorted.end(), [](const BrokenBond *a, const BrokenBond *b) {
    return a->centroid[0] < b->centroid[0];
  });

  std::vector<double> distances;
  distances.reserve(from.size());
  for (const auto &bond : from) {
    const double *x = bond.centroid;
    double best = HUGE_VAL;
    const auto visit = [&](const BrokenBond &other) {
      const double *y = other.centroid;
      best = std::min(best, std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]));
      return std::abs(x[0] - y[0]) <= best;
    };
    const auto middle =
        std::lower_bound(sorted.begin(), sorted.end(), x[0],
                         [](const BrokenBond *b, double value) { return b->centroid[0] < value; });
    for (auto right = middle; right != sorted.end() && visit(**right); ++right)
      ;
    for (auto left = middle; left != sorted.begin() && visit(**(left - 1)); --left)
      ;
    distances.push_back(best);
  }
  return distances;
}
} // namespace ligament::program
