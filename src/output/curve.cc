#include "src/output/curve.h"

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
double largest_magnitude(const std::vector<double> &values)
{
  double largest = 0;
  for (const double value : values)
    if (std::isfinite(value))
      largest = std::max(largest, std::abs(value));
  return largest;
}
} // namespace

// A broken half that swings back can press harder than the specimen was pulled: only loads with the
// sign of the mean load count.
std::optional<std::size_t> peak_index(const std::vector<double> &load)
{
  double mean = 0;
  for (const double value : load)
    if (std::isfinite(value))
      mean += value;
  std::optional<std::size_t> peak;
  for (std::size_t i = 0; i < load.size(); ++i)
    if (load[i] * mean > 0 && (!peak || std::abs(load[i]) > std::abs(load[*peak])))
      peak = i;
  return peak;
}

std::optional<double> fit_stiffness(const std::vector<double> &displacement,
                                    const std::vector<double> &load)
{
  const auto peak = peak_index(load);
  if (!peak)
    return {};
  double n = 0, mean_x = 0, mean_y = 0;
  const auto for_each_point = [&](auto &&visit) {
    for (std::size_t i = 0; i < *peak; ++i) {
      const double share = load[i] / load[*peak];
      if (share >= 0.1 && share <= 0.5 && std::isfinite(displacement[i]))
        visit(displacement[i], load[i]);
    }
  };
  for_each_point([&](double x, double y) {
    n += 1;
    mean_x += x;
    mean_y += y;
  });
  if (n < 3)
    return {};
  mean_x /= n;
  mean_y /= n;
  double xx = 0, xy = 0;
  for_each_point([&](double x, double y) {
    xx += (x - mean_x) * (x - mean_x);
    xy += (x - mean_x) * (y - mean_y);
  });
  return xx > 0 ? std::optional(xy / xx) : std::nullopt;
}

std::optional<double> relative_residual(const std::vector<double> &residual,
                                        const std::vector<double> &external_work)
{
  const double work = largest_magnitude(external_work);
  return work > 0 ? std::optional(largest_magnitude(residual) / work) : std::nullopt;
}
} // namespace ligament::program
