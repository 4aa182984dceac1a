#include "md/sampled_spline.h"

#include <algorithm>

namespace ligament::md
{
Spline sample(const FunctionOfDistance &function, double end, int n, double own_end)
{
  const double step = end / n, tenth = 0.1 * own_end;
  const double left = function(own_end),
               slope = -slope_at_first(step, left, function(own_end - step),
                                       function(own_end - 2 * step), function(own_end - 3 * step));
  std::vector<double> values(n + 1, 0.);
  for (int k = 1; k < n; ++k) {
    const double x = k * step, s = std::max(0., (x - own_end) / tenth + 1);
    if (x < own_end)
      values[k] = function(x) - s * s * (left * (3 - 2 * s) + slope * tenth * (s - 1));
  }
  values[0] = 2 * values[1] - values[2];
  return {step, values, slope_at_first(step, values[0], values[1], values[2], values[3]), 0.};
}

double taper(double x, double begin, double end)
{
  const double s = std::clamp((x - begin) / (end - begin), 0., 1.);
  return 1 - s * s * s * (10 + s * (6 * s - 15));
}
} // namespace ligament::md
