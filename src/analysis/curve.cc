#include "src/analysis/curve.h"

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
// Of the load at the end of the fit: how far the line may miss the points, in the mean square.
constexpr double largest_misfit = 0.02;
// Of the displacement at the largest load: a specimen shorter than that has been let go.
constexpr double back_share = 0.5;

double largest_magnitude(const std::vector<double> &values)
{
  double largest = 0;
  for (const double value : values)
    if (std::isfinite(value))
      largest = std::max(largest, std::abs(value));
  return largest;
}
} // namespace

bool is_let_go(double extension, double then)
{
  return (then < 0 ? -extension : extension) < back_share * std::abs(then);
}

std::size_t loading_rows(const std::vector<double> &load, const std::vector<double> &extension)
{
  const double noise = fallen_share * largest_magnitude(load);
  std::size_t largest = 0; // row
  const auto first = std::find_if(extension.begin(), extension.end(),
                                  [](double value) { return std::isfinite(value); });
  const double origin = first == extension.end() ? 0 : *first; // of a gauge
  const auto has_fallen = [&](std::size_t i) {
    const double most = load[largest], along = std::copysign(load[i], load[i] * most);
    return std::abs(most) > noise && along < fallen_share * std::abs(most) &&
           (extension.empty() || !is_let_go(extension[i] - origin, extension[largest] - origin));
  };
  for (std::size_t i = 0; i < load.size(); ++i) {
    if (!std::isfinite(load[i]))
      continue;
    if (has_fallen(i))
      return i;
    if (!(std::abs(load[i]) <= std::abs(load[largest])))
      largest = i;
  }
  return load.size();
}

std::optional<std::size_t> largest_index(const std::vector<double> &load, std::size_t n_rows)
{
  std::optional<std::size_t> index;
  for (std::size_t i = 0; i < std::min(n_rows, load.size()); ++i)
    if (std::isfinite(load[i]) && std::abs(load[i]) > (index ? std::abs(load[*index]) : 0))
      index = i;
  return index;
}

std::optional<double> fit_stiffness(const std::vector<double> &displacement,
                                    const std::vector<double> &load, std::size_t peak)
{
  const auto first_at = [&](double share) {
    std::size_t i = 0;
    while (i < peak && !(load[i] / load[peak] >= share))
      ++i;
    return i;
  };
  const std::size_t begin = first_at(0.1), end = first_at(0.5);
  if (end < begin + 3)
    return {};
  const double n = double(end - begin);
  double mean_x = 0, mean_y = 0, largest = 0;
  for (std::size_t i = begin; i < end; ++i) {
    mean_x += displacement[i] / n;
    mean_y += load[i] / n;
    largest = std::max(largest, std::abs(load[i]));
  }
  double xx = 0, xy = 0, yy = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const double x = displacement[i] - mean_x, y = load[i] - mean_y;
    xx += x * x;
    xy += x * y;
    yy += y * y;
  }
  if (!(xx > 0))
    return {};
  const double misfit = std::sqrt(std::max(yy - xy * xy / xx, 0.) / n);
  return misfit <= largest_misfit * largest ? std::optional(xy / xx) : std::nullopt;
}
} // namespace ligament::program
