// Loads on parts of the specimen's sides, and their course in time; both models read the same ones.
#pragma once

#include "core/part.h"
#include "core/time_function.h"

#include <algorithm>
#include <optional>

namespace ligament::core
{
/// What acts on one side of the specimen, or a part of it. A component without a value is free.
template <int dim>
struct BoundaryLoad
{
  enum class Kind
  {
    velocity,     // m/s: value * history.value(t)
    displacement, // m: value * history.value(t)
    traction,     // Pa: value * history.value(t)
    acceleration  // m/s^2: value * history.value(t), of every mass of the body
  };
  /// The boundary of an acceleration, which has none.
  static constexpr int whole_body = -1;
  /// The boundary of the jump of the displacement across the periodic sides of an axis (kinds
  /// velocity and displacement): what the image one period further has in addition.
  static constexpr int jump_across(int axis) { return -2 - axis; }
  /// That axis; -1: it is not such a load.
  int jump_axis() const { return boundary <= -2 ? -2 - boundary : -1; }
  int boundary = 0;
  Kind kind = Kind::velocity;
  std::array<std::optional<double>, dim> value;
  /// Of kind traction, in place of a value, in Pa: times history.value(t), against the present
  /// outward normal of what it acts on.
  std::optional<double> pressure;
  TimeFunction history;
  Part<dim> part;
  /// Waves leave through this side, beside the traction (theory.md eq. (A1)); kind traction only.
  bool absorbing = false;
  double absorbing_layer = 0; // m, width of the damping layer inside it; 0: dashpots alone

  /// Prescribed displacement of component c at time t, in m (kinds velocity and displacement).
  double displacement(int c, double t) const;
  double velocity(int c, double t) const;
  /// In Pa at time t; zero where it is no pressure.
  double pressure_at(double t) const { return pressure ? *pressure * history.value(t) : 0; }
  /// Given traction in Pa or acceleration in m/s^2; zero for components without a value.
  Vector<dim> traction(double t) const;
};
} // namespace ligament::core
