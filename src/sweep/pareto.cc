#include "src/sweep/pareto.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace ligament::program
{
std::vector<std::size_t> pareto_front(const std::vector<double> &cost,
                                      const std::vector<double> &error)
{
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < std::min(cost.size(), error.size()); ++i)
    if (std::isfinite(cost[i]) && std::isfinite(error[i]))
      order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tie(cost[a], error[a], a) < std::tie(cost[b], error[b], b);
  });
  // By rising cost, a point is worth its cost when it lowers the error.
  std::vector<std::size_t> front;
  double best = std::numeric_limits<double>::infinity();
  for (const std::size_t i : order)
    if (error[i] < best) {
      best = error[i];
      front.push_back(i);
    }
  return front;
}
} // namespace ligament::program
