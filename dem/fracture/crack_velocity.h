// A face that breaks lets go as a crack crosses it, not at once: theory.md section 1.15.
#pragma once

#include <algorithm>
#include <cmath>

namespace ligament::dem
{
/// What is left of the strength of a face falls in time, from when it breaks on.
struct FallInTime
{
  double begin = 0, duration = 0; // s; no duration: it does not fall by itself

  bool is_on() const { return duration > 0; }
  /// Share that has gone.
  double gone(double time) const { return std::clamp((time - begin) / duration, 0., 1.); }
};

/// Time in s in which a crack of this velocity crosses a face of this area (m^2).
template <int dim>
double crossing_time(double area, double thickness, double velocity)
{
  return (dim == 2 ? area / thickness : std::sqrt(area)) / velocity;
}
} // namespace ligament::dem
