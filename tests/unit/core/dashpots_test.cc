// Dashpots of single masses against the closed form of their step.
#include "core/dashpots.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ligament::core
{
namespace
{
// v(+) (1 + g) = v(-) (1 - g) + dt f/m with g = c dt/2m, whatever g; the energy is what the kinetic
// energy and the work of f say.
TEST(Dashpots, ActOnTheMeanVelocity)
{
  for (const double c : {0.3, 2., 500.}) {
    const double dt = 0.1, m = 0.5, f = 0.7, before = -1.3, g = c * dt / (2 * m);
    const std::vector<double> inverse_mass = {0., 1 / m};
    Components<2> force, velocity;
    for (auto *a : {&force, &velocity})
      for (auto &x : *a)
        x.assign(2, 0.);
    force[1][1] = f;
    velocity[1][1] = before + dt * f / m;
    Dashpots<2> dashpots({{{1, 1}, c}, {{0, 0}, c}});
    dashpots.act(
        dt, [&](int i) { return inverse_mass[i]; }, force, velocity);
    const double after = velocity[1][1];
    EXPECT_NEAR(after, (before * (1 - g) + dt * f / m) / (1 + g), 1e-14);
    const double work = f * dt * (before + after) / 2;
    EXPECT_NEAR(dashpots.energy(), work + m / 2 * (before * before - after * after), 1e-14);
    EXPECT_EQ(velocity[0][1], 0);
    EXPECT_EQ(velocity[0][0], 0); // a held one stays
  }
}

TEST(Dashpots, LayerRisesFromItsInnerBorder)
{
  EXPECT_EQ(layer_rate(-1, 4, 3), 0);
  EXPECT_EQ(layer_rate(0, 4, 3), 0);
  EXPECT_DOUBLE_EQ(layer_rate(2, 4, 3), layer_rate(4, 4, 3) / 4);
  EXPECT_DOUBLE_EQ(layer_rate(4, 4, 3), layer_rate(8, 8, 6));
}
} // namespace
} // namespace ligament::core
