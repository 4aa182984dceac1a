// Courses in time: value, integral and rate belong together, and turn at their corners alone.
#include "core/check.h"
#include "core/time_function.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace ligament::core;

namespace
{
struct Named
{
  const char *name;
  TimeFunction f;
};

std::vector<Named> all_forms()
{
  return {{"ramp", Ramp{0.7}},
          {"step", Ramp{}},
          {"table", TimeTable({{0.1, 0.5}, {0.4, 1}, {0.9, 1}, {1.3, -2}})},
          {"half sine", Pulse{Pulse::Shape::half_sine, 0.2, 0.9}},
          {"ricker", Pulse{Pulse::Shape::ricker, 0.2, 0.9}},
          {"cycles", Cycles{Ramp{0.3}, 0.4, 0.7, 0.5}},
          {"cycles about nothing", Cycles{Ramp{}, 0, 1, 0.5}}};
}

/// Is there a corner within reach of the time?
bool is_near_corner(const TimeFunction &f, double t, double reach)
{
  return f.next_corner(t - reach) <= t + reach || t < reach;
}

TEST(TimeFunction, IntegralAndRateAreThoseOfTheValue)
{
  const double h = 1e-4;
  for (const auto &[name, f] : all_forms())
    for (double t = 0.0137; t < 2; t += 0.0513) {
      if (is_near_corner(f, t, 2 * h))
        continue;
      SCOPED_TRACE(name);
      // Central differences: the error is h^2/6 times a third derivative, below (15/s)^3 here.
      EXPECT_NEAR((f.integral(t + h) - f.integral(t - h)) / (2 * h), f.value(t), 3e-6) << t;
      EXPECT_NEAR((f.value(t + h) - f.value(t - h)) / (2 * h), f.rate(t), 5e-5) << t;
    }
}

TEST(TimeFunction, NothingIsThereBeforeTheBeginning)
{
  for (const auto &[name, f] : all_forms()) {
    EXPECT_EQ(f.value(-0.1), 0) << name;
    EXPECT_EQ(f.integral(-0.1), 0) << name;
    EXPECT_EQ(f.integral(0), 0) << name;
  }
}

TEST(TimeFunction, TurnsOnlyAtCorners)
{
  for (const auto &[name, f] : all_forms())
    for (double from = 0; from < 2;) {
      const double to = std::min(2., f.next_corner(from));
      int n_up = 0, n_down = 0, n_above = 0, n_below = 0;
      for (int k = 0; k < 50; ++k) {
        const double a = from + (to - from) * (k + 0.01) / 50.5,
                     b = from + (to - from) * (k + 0.99) / 50.5, rise = f.value(b) - f.value(a);
        n_up += rise > 1e-12;
        n_down += rise < -1e-12;
        n_above += f.value(a) > 1e-12;
        n_below += f.value(a) < -1e-12;
      }
      EXPECT_TRUE(n_up == 0 || n_down == 0) << name << " from " << from << " to " << to;
      EXPECT_TRUE(n_above == 0 || n_below == 0) << name << " from " << from << " to " << to;
      from = to;
    }
}

TEST(TimeFunction, PulsesPeakAtOneAndEnd)
{
  const Pulse sine{Pulse::Shape::half_sine, 0.2, 0.9}, wavelet{Pulse::Shape::ricker, 0.2, 0.9};
  for (const Pulse &p : {sine, wavelet}) {
    EXPECT_NEAR(p.value(0.65), 1, 1e-15);
    EXPECT_EQ(p.value(0.2), 0);
    EXPECT_EQ(p.value(1.1), 0);
    EXPECT_EQ(p.integral(3), p.integral(1.2));
  }
  EXPECT_NEAR(sine.integral(2), 2 * 0.9 / M_PI, 1e-15);
  // 44.4 exp(-22.2), and an integral that is one of its ends over the largest one
  EXPECT_NEAR(wavelet.value(0.2 + 1e-9), 0, 1.1e-8);
  EXPECT_NEAR(wavelet.integral(2) / 0.9, 0, 3e-10);
}

TEST(TimeFunction, TablesAreLevelOutside)
{
  const TimeTable t({{0.1, 0.5}, {0.4, 1}});
  EXPECT_EQ(t.value(0), 0.5);
  EXPECT_EQ(t.value(0.05), 0.5);
  EXPECT_EQ(t.value(0.25), 0.75);
  EXPECT_EQ(t.value(7), 1);
  EXPECT_NEAR(t.integral(1), 0.05 + 0.3 * 0.75 + 0.6, 1e-15);
  EXPECT_TRUE(TimeFunction(t).jumps());
  EXPECT_THROW(TimeTable({{0, 1}, {0, 2}}), InputError);
  EXPECT_THROW(TimeTable({{-1, 1}}), InputError);
}

// The default of loads: it must be the ramp of before, to the bit.
TEST(TimeFunction, RampIsTheOneOfItsFormula)
{
  const TimeFunction f = Ramp{0.3};
  const double s = 0.11 / 0.3;
  EXPECT_EQ(f.value(0.11), s - std::sin(2 * M_PI * s) / (2 * M_PI));
  EXPECT_TRUE(f.is_ramp());
  EXPECT_FALSE(f.jumps());
  EXPECT_TRUE(TimeFunction().jumps());
}
} // namespace
