#include "src/simulation/servo_law.h"

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
// Of the response time: each low pass; of the error in that time, what the integral grows by.
constexpr double filter_share = 0.25, integral_share = 0.25;
// Of the motion that the scale takes: from there on the gain is learned rather than given.
constexpr double learned_share = 0.1;
constexpr double largest_factor = 10; // between the two
} // namespace

double servo_lag(double response)
{
  return 2 * filter_share * response;
}

// The secant through reading and motion, held to the given gain while both are small.
double ServoLaw::present_gain() const
{
  const double weight = std::pow(learned_share * scale_ / gain_, 2),
               all = weight + moved_.twice * moved_.twice;
  if (all == 0)
    return gain_;
  const double ratio = (weight + measured_.twice * moved_.twice / gain_) / all;
  return gain_ * std::clamp(ratio, 1 / largest_factor, largest_factor);
}

double ServoLaw::speed(const Reading &r, double step, double fastest)
{
  const double passed = -std::expm1(-step / (filter_share * response_));
  measured_.add(r.measured, passed);
  moved_.add(r.moved, passed);
  const double error = r.wanted - servo_lag(response_) * r.wanted_rate - measured_.twice;
  const double integral = integral_ + step * integral_share * error / response_;
  const double gain = present_gain();
  const double asked = (r.wanted_rate + (error + integral) / response_) / gain;
  const double speed = std::clamp(asked, -fastest, fastest);
  // Beyond the bound only what leads back is integrated.
  if (speed == asked || (asked - speed) * error / gain < 0)
    integral_ = integral;
  return speed;
}

void ServoLaw::save(core::State &state, const std::string &name) const
{
  core::save_value(state, name, "measured_once", measured_.once);
  core::save_value(state, name, "measured_twice", measured_.twice);
  core::save_value(state, name, "moved_once", moved_.once);
  core::save_value(state, name, "moved_twice", moved_.twice);
  core::save_value(state, name, "integral", integral_);
}

void ServoLaw::load(const core::State &state, const std::string &name)
{
  measured_ = {core::load_real(state, name, "measured_once"),
               core::load_real(state, name, "measured_twice")};
  moved_ = {core::load_real(state, name, "moved_once"),
            core::load_real(state, name, "moved_twice")};
  integral_ = core::load_real(state, name, "integral");
}
} // namespace ligament::program
