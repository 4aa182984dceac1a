// What a packing fills: a box or a solid with holes, notches and cracks, or a zone of it.
#pragma once

#include "core/box_union.h"
#include "core/solid.h"

#include <array>
#include <memory>
#include <vector>

namespace ligament::packings
{
/// 2D: a disc cut out of the specimen, in m; its radius must be at least the spacing.
template <int dim>
struct DiscHole
{
  Vector<dim> centre;
  double radius;
};

/// A box cut out of the specimen, in m; each of its sides must be at least the spacing wide. A side
/// on the surface of the specimen, or beyond it, opens the notch there.
template <int dim>
struct BoxNotch
{
  Vector<dim> lower, upper;
};

/// A cut without width: 2D a segment (two points), 3D a convex plane polygon, in m.
template <int dim>
using CrackPoints = std::vector<Vector<dim>>;

template <int dim>
struct SpecimenParameters
{
  double spacing = 0;                      // m, d of theory.md section 1.1
  double thickness = 1;                    // m, 2D only
  Vector<dim> lower = Vector<dim>::Zero(); // m, specimen
  Vector<dim> upper = Vector<dim>::Zero();
  /// The body between them, which lies in this box and touches its sides; null: the box itself.
  std::shared_ptr<const core::Solid<dim>> solid;
  /// Axes along which the body repeats itself: the sides across them are joined (periodic_sides.h).
  std::array<bool, dim> periodic = {};
  std::vector<DiscHole<dim>> holes;
  std::vector<BoxNotch<dim>> notches;
  std::vector<CrackPoints<dim>> cracks;
  Vector<dim> zone_lower = Vector<dim>::Constant(-1e300); // m, what is packed
  Vector<dim> zone_upper = Vector<dim>::Constant(1e300);
  core::BoxUnion<dim> zone_parts; // what of that; empty: all of it
};
} // namespace ligament::packings
