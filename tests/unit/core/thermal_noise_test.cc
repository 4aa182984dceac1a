// Moments of the noise and that its streams know nothing of each other.
#include "core/thermal_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace ligament
{
namespace
{
using core::ThermalNoise;

// A mean of n numbers of variance v lies within five sqrt(v / n) but for 6e-7 of the tries.
constexpr double n_sigma = 5;
constexpr int n = 1 << 20;

TEST(ThermalNoise, HasTheMomentsOfASumOfFourUniformNumbers)
{
  const ThermalNoise noise(7, 12);
  double sum[7] = {};
  for (int i = 0; i < n; ++i) {
    const double x = noise(i, i % 3, i % 2);
    for (int k = 1; k < 7; ++k)
      sum[k] += std::pow(x, k) / n;
  }
  // Moments of normal numbers, which are larger, bound the scatter.
  const double sigma = n_sigma / std::sqrt(double(n));
  EXPECT_NEAR(sum[1], 0, sigma);
  EXPECT_NEAR(sum[2], 1, sigma * std::sqrt(2.7 - 1));
  EXPECT_NEAR(sum[3], 0, sigma * std::sqrt(15.));
  EXPECT_NEAR(sum[4], 2.7, sigma * std::sqrt(105.)); // a normal number's eighth moment bounds it
}

// The exact variance: over all values of one part.
TEST(ThermalNoise, HasUnitVarianceExactly)
{
  double variance = 0;
  for (int k = 0; k < 65536; ++k)
    variance += std::pow(k - 65535 / 2., 2) / 65536;
  EXPECT_NEAR(4 * variance * std::pow(ThermalNoise::scale, 2), 1, 1e-12);
}

TEST(ThermalNoise, StreamsAreIndependent)
{
  const ThermalNoise noise(7, 12), later(7, 13), other(8, 12);
  const std::function<double(int)> shifted[] = {
      [&](int i) { return noise(i + 1, 0, 0); }, [&](int i) { return noise(i, 1, 0); },
      [&](int i) { return noise(i, 0, 1); },     [&](int i) { return later(i, 0, 0); },
      [&](int i) { return other(i, 0, 0); },     [&](int i) { return later(i + 1, 0, 0); }};
  for (const auto &y : shifted) {
    double product = 0, squares = 0;
    for (int i = 0; i < n; ++i) {
      product += noise(i, 0, 0) * y(i) / n;
      squares += (std::pow(noise(i, 0, 0), 2) - 1) * (std::pow(y(i), 2) - 1) / n;
    }
    EXPECT_NEAR(product, 0, n_sigma / std::sqrt(double(n)));
    EXPECT_NEAR(squares, 0, n_sigma * 1.7 / std::sqrt(double(n)));
  }
}

TEST(ThermalNoise, FollowsFromItsNamesAlone)
{
  EXPECT_EQ(ThermalNoise(1, 2)(3, 1, 1), ThermalNoise(1, 2)(3, 1, 1));
  EXPECT_NE(ThermalNoise(1, 2)(3, 1, 1), ThermalNoise(2, 1)(3, 1, 1));
  EXPECT_NE(ThermalNoise(1, -1)(3, 1, 1), ThermalNoise(1, 0)(3, 1, 1));
}
} // namespace
} // namespace ligament
