// The energies that the noise runs judge: shadow energy of a mode, step error of the impulses,
// slope and scatter of a series.
#include "src/verification/bodies/unit_bodies.h"
#include "src/verification/instruments/noise_run.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ligament::program
{
namespace
{
TEST(ShadowEnergy, OfEveryModeIsThatOfTheExactFlow)
{
  // theory.md eqs. (E6) to (E8), over b^2/2.
  for (const double fraction : {0.5, 0.9}) {
    const auto c = shadow_coefficients(fraction, 10);
    for (double half_turn = 0.05; std::sin(half_turn) < fraction; half_turn += 0.05) {
      const double turn = 2 * half_turn;
      double energy = (1 + std::cos(turn)) / 2;
      for (std::size_t k = 0; k < c.size(); ++k)
        energy += c[k] * (std::cos(k * turn) - std::cos((k + 2) * turn));
      // Error of the interpolation: 2.5 per term at 0.9 of the critical step.
      EXPECT_NEAR(energy, half_turn / std::tan(half_turn), std::pow(2.5, -10)) << half_turn;
    }
  }
}

TEST(Course, OfALineIsItsSlope)
{
  std::vector<double> line;
  for (int k = 0; k < 1000; ++k)
    line.push_back(1 + 1e-6 * (k - 499.5));
  const Course c = course_of(line, 5);
  EXPECT_NEAR(c.drift, 1e-6 / 5 * 1e5, 1e-9);
  EXPECT_LT(c.error, 1e-9);
  EXPECT_NEAR(c.fluctuation, 1e-6 * 499.5, 1e-12);
}

double fluctuation(int step_ratio)
{
  Scene scene = unit_scene(2, {18, 118, 0}, 0.22);
  add_far_field(scene, {0, 34, 0}, 4.6);
  scene.coupling.step_ratio = step_ratio;
  UnitBody<2> unit(scene);
  const auto series = run_noise(unit.body, 1e-8, 1600, 4, 0);
  return course_of(series.leap_frog, 4).fluctuation;
}

TEST(Impulses, LeaveAnErrorOfFourthOrder)
{
  // Without (E5) the ratio is that of m^2 - 1, 5; what (E5) leaves grows with the fourth power.
  EXPECT_GT(fluctuation(4) / fluctuation(2), 10);
}
} // namespace
} // namespace ligament::program
