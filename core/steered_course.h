// A course in time that is told where to go while the run goes on.
#pragma once

#include "core/state.h"

#include <memory>

namespace ligament::core
{
/// Straight from corner to corner; the last corner lies at the present or ahead of it. Where a
/// correction made at one step begins at the next, forces found with the course before stay true.
class SteeredCourse
{
public:
  double value(double t) const { return at(t).value_at(t); }
  /// From 0 to t, in s.
  double integral(double t) const { return at(t).integral_at(t); }
  double rate(double t) const { return at(t).rate; }

  /// From time t on, not before the last corner, it changes at this rate in 1/s.
  void turn(double t, double rate);

  void save(State &state, const std::string &name) const;
  void load(const State &state, const std::string &name);

private:
  struct Line
  {
    double time = 0, value = 0, integral = 0, rate = 0; // s, -, s, 1/s, at its beginning

    double value_at(double t) const { return value + rate * (t - time); }
    double integral_at(double t) const
    {
      return integral + (value + rate / 2 * (t - time)) * (t - time);
    }
  };
  const Line &at(double t) const { return t < now_.time ? before_ : now_; }

  Line before_, now_;
};

/// As a course of a load: all copies follow the same one.
struct Steered
{
  std::shared_ptr<SteeredCourse> course = std::make_shared<SteeredCourse>();

  double value(double t) const { return course->value(t); }
  double integral(double t) const { return course->integral(t); }
  double rate(double t) const { return course->rate(t); }
  /// Never: where it turns is not known.
  double next_corner(double t) const;
};
} // namespace ligament::core
