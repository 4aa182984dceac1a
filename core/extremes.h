// Extremes of many values, for figures that are held against a bound.
#pragma once

#include <cmath>

namespace ligament
{
/// The larger one; not a number as soon as one is, which std::max passes over.
inline void keep_largest(double &worst, double value)
{
  if (!std::isnan(worst) && !(value <= worst))
    worst = value;
}

/// The smaller one, likewise.
inline void keep_smallest(double &least, double value)
{
  if (!std::isnan(least) && !(value >= least))
    least = value;
}
} // namespace ligament
