// How a load grows, swings and ends in time: values without unit, with integral and rate.
#pragma once

#include "core/steered_course.h"

#include <array>
#include <variant>
#include <vector>

namespace ligament::core
{
/// Growth from 0 to 1 over `duration` seconds without a jump of the rate:
/// f(t) = s - sin(2 pi s)/(2 pi), s = t/duration.
struct Ramp
{
  double duration = 0; // s; 0: a step

  double value(double t) const;
  /// Integral of value from 0 to t, in s.
  double integral(double t) const;
  /// d(value)/dt, in 1/s.
  double rate(double t) const;
  /// The next time after t at which it bends, turns or passes zero, in s; infinite when there is
  /// none.
  double next_corner(double t) const;
};

/// Straight lines between points; level before the first and after the last one.
class TimeTable
{
public:
  /// Pairs of a time in s, from 0 on and rising, and a value; at least one.
  explicit TimeTable(std::vector<std::array<double, 2>> rows);

  double value(double t) const;
  double integral(double t) const;
  double rate(double t) const;
  double next_corner(double t) const;

private:
  /// Number of the last row that is not after t; -1: t is before all.
  int row_at(double t) const;

  std::vector<std::array<double, 2>> rows_;
  std::vector<double> integral_; // from 0 to each row
};

/// One pulse with the peak 1, and nothing before and after it.
struct Pulse
{
  enum class Shape
  {
    half_sine,
    /// (1 - 2 a^2) exp(-a^2), a = pi f (t - middle), f = 3/duration: at the ends 1e-8.
    ricker
  };
  Shape shape = Shape::half_sine;
  double start = 0, duration = 1; // s

  double value(double t) const;
  double integral(double t) const;
  double rate(double t) const;
  double next_corner(double t) const;
};

/// The mean is reached by the ramp, then mean + amplitude sin(2 pi (t - ramp)/period).
struct Cycles
{
  Ramp ramp;
  double mean = 0, amplitude = 1, period = 1; // -, -, s

  double value(double t) const;
  double integral(double t) const;
  double rate(double t) const;
  double next_corner(double t) const;
};

/// Any of them; by default 1 from time 0 on. At negative times all are 0.
class TimeFunction
{
public:
  TimeFunction() = default;
  template <typename Form>
  TimeFunction(Form form) : form_(std::move(form))
  {
  }

  double value(double t) const;
  /// Of value from 0 to t, in s.
  double integral(double t) const;
  /// In 1/s.
  double rate(double t) const;
  /// The next time after t at which it bends, turns or passes zero, in s; infinite without one.
  double next_corner(double t) const;

  /// It is there at once.
  bool jumps() const { return value(0) != 0; }
  /// It never falls: between its corners nothing turns.
  bool is_ramp() const { return std::holds_alternative<Ramp>(form_); }
  /// What a servo tells where to go; null: it is known from the beginning.
  SteeredCourse *steered() const
  {
    const Steered *form = std::get_if<Steered>(&form_);
    return form ? form->course.get() : nullptr;
  }

private:
  std::variant<Ramp, TimeTable, Pulse, Cycles, Steered> form_;
};
} // namespace ligament::core
