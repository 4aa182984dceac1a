// How a machine moves so that what it measures follows what is wanted: theory.md section 8.2.
#pragma once

#include "core/state.h"

namespace ligament::program
{
/// Proportional and integral, on a reading from which two low passes take the waves, with the
/// wanted rate fed forward. Bounded; what the bound keeps back is not integrated. The gain is
/// learned from reading and motion so far, within a factor of ten of the one given.
class ServoLaw
{
public:
  /// `gain`: of the quantity by m of motion; `response` in s; `scale` of the quantity.
  ServoLaw(double gain, double response, double scale)
      : gain_(gain), response_(response), scale_(scale)
  {
  }

  struct Reading
  {
    double measured, wanted, wanted_rate; // -, -, per s
    double moved;                         // m, so far
  };
  /// The speed in m/s, at most `fastest`, from readings `step` s apart.
  double speed(const Reading &reading, double step, double fastest);

  void save(core::State &state, const std::string &name) const;
  void load(const core::State &state, const std::string &name);

private:
  /// What both low passes leave.
  struct Smooth
  {
    double once = 0, twice = 0;
    void add(double value, double share)
    {
      once += share * (value - once);
      twice += share * (once - twice);
    }
  };
  double present_gain() const;

  double gain_, response_, scale_;
  Smooth measured_, moved_;
  double integral_ = 0; // of the error, over the response time
};

/// s, of the two low passes together what a steady rise lags behind.
double servo_lag(double response);
} // namespace ligament::program
