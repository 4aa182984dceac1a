// The cell of a particle near the surface: Voronoi cell, cut by the specimen, minus the voids.
#pragma once

#include "particles/lattice.h"
#include "particles/specimen_shape.h"

namespace ligament::particles
{
/// Lattice points nearer than this share of d to the surface carry no particle. The small change
/// lets points at just this distance all decide alike.
inline constexpr double clearance = 0.25 - 1e-9;

template <int dim>
bool is_kept(const SpecimenShape<dim> &shape, const Vector<dim> &x, double spacing)
{
  return shape.distance(x) >= clearance * spacing;
}

/// Per unit thickness in 2D.
template <int dim>
struct ClippedCell
{
  struct Part
  {
    int neighbour;      // place in Lattice::reachable, or -1
    int boundary;       // side of the specimen, inner_surface<dim>, or -1
    Vector<dim> normal; // unit, out of the cell
    double distance;    // m, from the centre to the plane
    double area;        // m^(dim-1)
    Vector<dim> moment; // area times centroid, about the centre
  };

  /// The cell of lattice point k. Throws core::InputError where material is thinner than the
  /// particles can fill, so that a cell would reach through a void.
  ClippedCell(const Lattice<dim> &lattice, const SpecimenShape<dim> &shape,
              const LatticeIndex<dim> &k);

  double volume = 0; // m^dim
  std::vector<Part> parts;
  /// Smallest box around the cell, about the centre, in m.
  Vector<dim> lower = Vector<dim>::Constant(1e300), upper = -lower;
};
} // namespace ligament::particles
