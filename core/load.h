// Loads on the sides of the specimen and their growth in time; both models read the same ones.
#pragma once

#include "core/types.h"

#include <algorithm>
#include <optional>

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
};

/// What acts on one side of the specimen. A component without a value is free.
template <int dim>
struct BoundaryLoad
{
  enum class Kind
  {
    velocity,     // m/s: value * ramp.value(t)
    displacement, // m: value * ramp.value(t)
    traction      // Pa: value * ramp.value(t)
  };
  int boundary = 0;
  Kind kind = Kind::velocity;
  std::array<std::optional<double>, dim> value;
  Ramp ramp;
  /// Waves leave through this side, beside the traction (theory.md eq. (A1)); kind traction only.
  bool absorbing = false;
  double absorbing_layer = 0; // m, width of the damping layer inside it; 0: dashpots alone

  /// Prescribed displacement of component c at time t, in m (kinds velocity and displacement).
  double displacement(int c, double t) const;
  double velocity(int c, double t) const;
  /// Prescribed traction, in Pa; zero for components without a value.
  Vector<dim> traction(double t) const;
};
} // namespace ligament::core
