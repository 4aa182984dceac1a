// Whether forces and torques are minus the slope of an energy.
#pragma once

#include "core/extremes.h"
#include "tests/unit/dem/body.h"

#include <gtest/gtest.h>

namespace ligament::dem::testing
{
/// Of value(s) at s = 0, by two steps to either side: errs by h^4 of the fifth derivative and by
/// round-off over h.
template <typename Value>
double slope(double h, Value &&value)
{
  return (value(-2 * h) - 8 * value(-h) + 8 * value(h) - value(2 * h)) / (12 * h);
}

struct SlopeSteps
{
  double shift; // m
  double angle; // rad
};

/// Forces are minus the slopes of `energy` (of a state, J) to `tolerance` of the largest of them,
/// torques to that times `lever` (m); of every `stride`-th particle.
template <int dim, typename Energy>
void expect_minus_slope(const Particles<dim> &p, const SlopeSteps &steps, double tolerance,
                        double lever, int stride, Energy &&energy)
{
  const auto slope_along = [&](double step, auto &&change) {
    return slope(step, [&](double s) {
      auto q = p;
      change(q, s);
      return energy(q);
    });
  };
  double scale = 0;
  for (int i = 0; i < p.size(); ++i)
    keep_largest(scale, get(p.force, i).norm());
  ASSERT_GT(scale, 0);
  for (int i = 0; i < p.size(); i += stride) {
    for (int c = 0; c < dim; ++c)
      EXPECT_NEAR(p.force[c][i],
                  -slope_along(steps.shift, [&](auto &q, double s) { q.displacement[c][i] += s; }),
                  tolerance * scale);
    for (int c = 0; c < n_spins<dim>; ++c)
      EXPECT_NEAR(
          p.torque[c][i],
          -slope_along(steps.angle,
                       [&](auto &q, double s) { turn_by<dim>(q, i, s * Spin<dim>::Unit(c)); }),
          tolerance * scale * lever);
  }
}
} // namespace ligament::dem::testing
