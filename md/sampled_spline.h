// Functions of a distance as splines that end smoothly at a cut-off.
#pragma once

#include "md/spline.h"

#include <functional>

namespace ligament::md
{
using FunctionOfDistance = std::function<double(double)>;

/// `function` at n + 1 even knots up to the cut-off `end`, but zero from `own_end` <= end on. What
/// it has left there, value and slope, is taken away over the last tenth by a cubic; values at 0
/// follow from the next two, since many functions have no limit there.
Spline sample(const FunctionOfDistance &function, double end, int n, double own_end);
inline Spline sample(const FunctionOfDistance &function, double end, int n)
{
  return sample(function, end, n, end);
}

/// 1 below `begin`, 0 beyond `end`, with continuous curvature in between.
double taper(double x, double begin, double end);
} // namespace ligament::md
