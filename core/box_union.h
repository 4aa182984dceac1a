// A union of axis-parallel boxes: the shape of a discrete zone.
#pragma once

#include "core/types.h"

namespace ligament::core
{
/// Boxes may overlap or touch (then they are one piece) or lie apart. Sides may be infinite.
template <int dim>
struct BoxUnion
{
  struct Box
  {
    Vector<dim> lower, upper; // m
  };
  std::vector<Box> boxes;

  /// Does the union cover the box [lower, upper], up to a tolerance in m?
  bool covers(const Vector<dim> &lower, const Vector<dim> &upper, double tolerance) const;

  /// Does the open box (lower, upper), shrunk by the tolerance in m, meet the union?
  bool meets(const Vector<dim> &lower, const Vector<dim> &upper, double tolerance) const;

  /// Distance of a point from the edge of the union in m, in the largest-component norm: half the
  /// edge of the largest cube around the point that the union covers; negative outside. In one
  /// box it is the smallest distance to a side, at re-entrant corners the larger of two.
  double distance(const Vector<dim> &x) const;

  /// The points farther than `distance` (m) from the edge, as boxes that don't overlap.
  BoxUnion eroded(double distance) const;

private:
  std::vector<double> cuts(int axis, double lower, double upper) const;
};
} // namespace ligament::core
