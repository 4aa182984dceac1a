// The law of the servos on bodies that answer at once: what is wanted is reached, whatever the
// gain.
#include "src/simulation/servo_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace ligament;
using namespace ligament::program;

namespace
{
constexpr double response = 1, step = 0.01;

/// Rises to 1 in 20 response times with the rate 0 at both ends, then stays.
struct Course
{
  double value(double t) const
  {
    return t < 20 ? t / 20 - std::sin(M_PI * t / 10) / (2 * M_PI) : 1;
  }
  double rate(double t) const { return t < 20 ? (1 - std::cos(M_PI * t / 10)) / 20 : 0; }
};

/// The quantity is `truth` times the motion; errors from step to step.
std::vector<double> errors(ServoLaw law, double truth, double fastest, double end = 60)
{
  std::vector<double> errors;
  double moved = 0;
  const Course course;
  for (double t = 0; t < end; t += step) {
    const double measured = truth * moved;
    errors.push_back(measured - course.value(t));
    moved += step * law.speed({measured, course.value(t), course.rate(t), moved}, step, fastest);
  }
  return errors;
}

double largest(const std::vector<double> &values, double from = 0)
{
  double found = 0;
  for (std::size_t k = std::size_t(from / step); k < values.size(); ++k)
    found = std::max(found, std::abs(values[k]));
  return found;
}

// With the true gain the wanted rate fed forward does nearly all. What is left is what the two low
// passes, of time T each, make of the second derivative, 3 T^2 times it, pi/200 at most; the loop
// passes it on with a resonance below 2.
TEST(ServoLaw, WithTheTrueGainItFollows)
{
  EXPECT_LT(largest(errors(ServoLaw(3, response, 1), 3, 10)), 2 * 3 * 0.25 * 0.25 * M_PI / 200);
}

// The low passes and the integral have died away 20 response times after the end of the ramp:
// slowest of all poles with the integral's share is -0.2 of the response time, exp(-8) = 3e-4.
TEST(ServoLaw, WithAWrongGainItLearns)
{
  for (const double factor : {0.2, 0.5, 2., 5.})
    for (const double sign : {-1., 1.}) {
      SCOPED_TRACE(factor * sign);
      const auto e = errors(ServoLaw(3 * factor * sign, response, 1), 3 * sign, 10);
      EXPECT_LT(largest(e), 0.12); // a fixed gain five times too large is off by 0.4
      EXPECT_LT(largest(e, 60 - 1), 3e-3);
    }
}

TEST(ServoLaw, KeepsItsBoundAndForgetsWhatItCost)
{
  // Too slow until the course stands still: it arrives late, at its largest speed, without passing.
  const double fastest = 0.8 / 20;
  const auto e = errors(ServoLaw(1, response, 1), 1, fastest);
  EXPECT_LT(e[std::size_t(20 / step)], -0.15);
  EXPECT_LT(*std::max_element(e.begin(), e.end()), 0.02);
  EXPECT_LT(largest(e, 50), 2e-3);
}

TEST(ServoLaw, GoesOnFromItsState)
{
  ServoLaw law(2, response, 1), other(2, response, 1);
  for (int k = 0; k < 100; ++k)
    law.speed({0.01 * k, 0.012 * k, 1, 0.004 * k}, step, 5);
  core::State state;
  law.save(state, "servo");
  other.load(state, "servo");
  EXPECT_EQ(other.speed({1, 1.3, 1, 0.4}, step, 5), law.speed({1, 1.3, 1, 0.4}, step, 5));
}
} // namespace
