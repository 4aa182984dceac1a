// Splines pass through their values, have no kink in the curvature and keep small changes.
#include "md/spline.h"

#include "core/check.h"
#include "tests/unit/md/potentials.h"

#include <cmath>

namespace ligament::md::testing
{
Spline sine(int n)
{
  std::vector<double> values(n + 1);
  for (int k = 0; k <= n; ++k)
    values[k] = std::sin(2. * k / n);
  return {2. / n, values, 1, std::cos(2.)};
}

// The error of a cubic spline is that of the fourth derivative: 5/384 h^4.
TEST(SplineTest, FollowsAFunctionToFourthOrder)
{
  const int n = 20;
  const Spline s = sine(n);
  const double h = 2. / n;
  for (double x = 0; x <= 2; x += 0.013) {
    EXPECT_NEAR(s(x).value, std::sin(x), 5 / 384. * std::pow(h, 4));
    EXPECT_NEAR(s(x).slope, std::cos(x), std::pow(h, 3) / 24);
    EXPECT_NEAR(s(x).curvature, -std::sin(x), 3 / 8. * h * h);
  }
}

TEST(SplineTest, HasNoKinksInside)
{
  const Spline s = sine(20);
  const double h = s.step(), sliver = 1e-9 * h;
  for (int k = 1; k < 20; ++k) {
    const Jet before = s(k * h - sliver), after = s(k * h + sliver);
    EXPECT_NEAR(before.value, after.value, 4e-9 * h);
    EXPECT_NEAR(before.slope, after.slope, 4e-9 * h);
    EXPECT_NEAR(before.curvature, after.curvature, 1e-8);
  }
}

TEST(SplineTest, GoesOnAlongItsTangents)
{
  const Spline s = sine(20);
  EXPECT_NEAR(s(3).value, std::sin(2.) + std::cos(2.), 1e-12);
  EXPECT_NEAR(s(3).slope, std::cos(2.), 1e-12);
  EXPECT_EQ(s(3).curvature, 0);
  EXPECT_NEAR(s(-0.5).value, -0.5, 1e-12);
  EXPECT_NEAR(s(-0.5).slope, 1, 1e-12);
  EXPECT_TRUE(std::isnan(s(std::nan("")).value));
  EXPECT_TRUE(std::isnan(s.change(std::nan(""), 1)));
}

TEST(SplineTest, ChangesAreThoseOfValuesAndKeepTheirDigits)
{
  const Spline s = sine(20);
  for (const double x : {-0.2, 0., 0.05, 0.1, 0.731, 1.4, 1.96, 2., 2.3})
    for (const double by : {1e-3, -1e-3, 0.1, -0.1, 0.77, -0.77, 1.3, -1.3, 3., -3.})
      EXPECT_NEAR(s.change(x, by), s(x + by).value - s(x).value, 1e-14) << x << " " << by;
  for (const double x : {0.05, 0.731, 1.4}) {
    const double by = 1e-11, slope = s(x).slope, curvature = s(x).curvature;
    EXPECT_NEAR(s.change(x, by), by * (slope + by / 2 * curvature), 4e-16 * by);
  }
}

TEST(SplineTest, SumsAreExact)
{
  Spline s = sine(20);
  const Spline t = s;
  s.add(0.5, t);
  s.add_line(3);
  for (double x = 0; x <= 2; x += 0.1) {
    EXPECT_NEAR(s(x).value, 1.5 * t(x).value + 3 * x, 1e-14);
    EXPECT_NEAR(s(x).slope, 1.5 * t(x).slope + 3, 1e-13);
    EXPECT_NEAR(s(x).curvature, 1.5 * t(x).curvature, 1e-12);
  }
  EXPECT_THROW(s.add(1, sine(21)), core::InputError);
  EXPECT_THROW(Spline(1, {0, 1, 2}), core::InputError);
}
} // namespace ligament::md::testing
