// Lattice packings that repeat themselves in all directions but one.
#pragma once

#include "packings/lattice_packing.h"

#include <array>

namespace ligament::packings
{
/// Numbers of particles or cells along the axes across a bar: all alike, or each its own.
template <int dim>
struct Across
{
  Across(int all) { n.fill(all); } // implicit: most bars are square
  Across(const std::array<int, dim - 1> &each) : n(each) {}
  int operator[](int axis) const { return n[axis]; }
  int columns() const { return dim == 2 ? n[0] : n[0] * n[dim - 2]; }

  std::array<int, dim - 1> n;
};

/// Particles of spacing 1 in `layers` layers of `across` particles along each axis;
/// layers are stacked along the last axis, neighbours across the sides are those of the other side.
/// Missing neighbours of the first layer, and of the last one when `closed`, are free surface.
/// The first layer lies at 0. Lengths in units of the spacing; `across` is at least 3.
template <int dim>
Packing<dim> make_periodic_packing(LatticeKind kind, const Across<dim> &across, int layers,
                                   bool closed);
} // namespace ligament::packings
