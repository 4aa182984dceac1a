// Figures of load curves against formulas.
#include "src/analysis/curve.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace ligament::program;

namespace
{
TEST(Curve, StiffnessIsTheSlopeBetweenTenAndFiftyPercentBeforeThePeak)
{
  // Slack at the start, a line of slope k, softening near the peak, a fall behind it.
  const double k = 3.5e9, peak = 2e6;
  std::vector<double> strain, stress;
  for (int i = 0; i <= 400; ++i) {
    const double y = peak * i / 400.;
    const double share = y / peak;
    strain.push_back(y / k + (share < 0.1 ? -1e-4 : share > 0.5 ? 1e-3 * (share - 0.5) : 0));
    stress.push_back(y);
  }
  for (int i = 400; i > 0; --i) {
    strain.push_back(1e-2);
    stress.push_back(peak * i / 401.);
  }
  EXPECT_EQ(*peak_index(stress), 400u);
  EXPECT_NEAR(*fit_stiffness(strain, stress) / k, 1, 1e-9);

  // Compression: both signs turn, the slope stays.
  for (auto *values : {&strain, &stress})
    for (double &value : *values)
      value = -value;
  EXPECT_NEAR(*fit_stiffness(strain, stress) / k, 1, 1e-9);
}

TEST(Curve, PeakLiesInTheDirectionOfLoading)
{
  // Pulled slowly to 3, then the halves swing back with -4.
  EXPECT_EQ(*peak_index({0, 1, 2, 3, -4}), 3u);
  EXPECT_EQ(*peak_index({0, -1, -2, -3, 4}), 3u);
}

// The rebound after the first fall is larger; noise before the loading is no fall.
TEST(Curve, LoadingEndsWhereTheLoadHasFallen)
{
  const std::vector<double> load = {0, 1e-3, -1e-3, 10, 20, 18, 1.9, 25, -30};
  EXPECT_EQ(loading_rows(load), 6u);
  EXPECT_EQ(*peak_index(load), 4u);
  EXPECT_EQ(loading_rows({0, 10, 20, 18, 2.1, 25}), 6u); // never below a tenth
}

// Two cycles below the break: the machine lets go between them, and then the load falls while the
// specimen is as long as before.
TEST(Curve, UnloadingIsNoFall)
{
  const std::vector<double> load = {0, 10, 0, 12, 0.1, 20, 0, 25},
                            length = {0, 1, 0, 1.2, 0, 2, 2.1, 3};
  EXPECT_EQ(loading_rows(load, length), 6u);
  EXPECT_EQ(*peak_index(load, length), 5u);
  EXPECT_EQ(loading_rows(load), 2u); // nothing is known of the length
  EXPECT_EQ(loading_rows(load, {0, 1, NAN, 1.2, 0, 2, 2.1, 3}), 2u);
  std::vector<double> pressed = load, shorter = length;
  for (auto *values : {&pressed, &shorter})
    for (double &value : *values)
      value = -value;
  EXPECT_EQ(*peak_index(pressed, shorter), 5u);
  for (double &value : shorter)
    value += 7; // a gauge has some zero
  EXPECT_EQ(*peak_index(pressed, shorter), 5u);
}

TEST(Curve, StiffnessIsThatOfTheFirstRise)
{
  // A line of slope 2 to 10; it falls to 3 and rises again with slope 1.
  std::vector<double> x, y;
  for (int i = 0; i <= 100; ++i) {
    x.push_back(0.05 * i);
    y.push_back(0.1 * i);
  }
  for (int i = 0; i <= 100; ++i) {
    x.push_back(6 + 0.08 * i);
    y.push_back(3 + 0.08 * i);
  }
  EXPECT_EQ(*peak_index(y), 201u);
  EXPECT_NEAR(*fit_stiffness(x, y), 2, 1e-12);
}

TEST(Curve, WhatIsNoLineHasNoStiffness)
{
  // y = x^p misses its chord from 0.1 to 0.5 the more the larger p.
  const auto stiffness = [](double p) {
    std::vector<double> x, y;
    for (int i = 0; i <= 1000; ++i) {
      x.push_back(1e-3 * i);
      y.push_back(std::pow(x.back(), p));
    }
    return fit_stiffness(x, y);
  };
  EXPECT_TRUE(stiffness(1.1));
  EXPECT_FALSE(stiffness(2));
  std::vector<double> x, wave;
  for (int i = 0; i <= 1000; ++i) {
    x.push_back(1e-3 * i);
    wave.push_back(x.back() + 0.05 * std::sin(100 * x.back()));
  }
  EXPECT_FALSE(fit_stiffness(x, wave));
}

TEST(Curve, NothingToFitIsEmpty)
{
  EXPECT_FALSE(peak_index({}));
  EXPECT_FALSE(peak_index({0, 0, 0}));
  EXPECT_FALSE(fit_stiffness({0, 1, 2}, {0, 0, 0}));
  EXPECT_FALSE(fit_stiffness({0, 1}, {0, 1}));
  EXPECT_FALSE(fit_stiffness({1, 1, 1, 1, 1}, {0.2, 0.3, 0.4, 0.5, 1})); // no spread
  EXPECT_EQ(*peak_index({NAN, 1, 3, 2}), 2u);
}
} // namespace
