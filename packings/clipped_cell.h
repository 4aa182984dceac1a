// The cell of a particle near the surface: Voronoi cell, cut by the specimen, minus the voids.
#pragma once

#include "packings/lattice.h"
#include "packings/specimen_shape.h"
#include "packings/voronoi_cell.h"

#include <utility>

namespace ligament::packings
{
/// Lattice points nearer than this share of d to the surface carry no particle. The small change
/// lets points at just this distance all decide alike.
inline constexpr double clearance = 0.25 - 1e-9;

template <int dim>
bool is_kept(const SpecimenShape<dim> &shape, const Vector<dim> &x, double spacing)
{
  return shape.distance(x) >= clearance * spacing;
}

/// Numbers of the planes that bound a cell: from 0 the neighbours; below 0 the cube from which it
/// was cut, the sides of the specimen, and the sides of the voids.
inline constexpr int start_plane = -1, first_side_plane = -10, first_void_plane = -100;

/// Cuts a cell around x by the flat sides of the specimen.
template <int dim>
void clip_by_sides(VoronoiCell<dim> &cell, const SpecimenShape<dim> &shape, const Vector<dim> &x);

/// Per unit thickness in 2D.
template <int dim>
struct ClippedCell
{
  struct Part
  {
    int neighbour;      // number of the plane that made it, or -1
    int boundary;       // side of the specimen, inner_surface<dim>, or -1
    Vector<dim> normal; // unit, out of the cell
    double distance;    // m, from the centre to the plane
    double area;        // m^(dim-1)
    Vector<dim> moment; // area times centroid, about the centre
    /// About the centre, in turn: of 3D faces on a side of the specimen that no void cuts.
    std::vector<Vector<dim>> corners = {};
  };

  /// What the voids leave of a cell around x that was already cut by its neighbours and the sides
  /// of the specimen. Parts below 1e-12 d^(dim-1) are left out.
  ClippedCell(const VoronoiCell<dim> &cell, const SpecimenShape<dim> &shape, const Vector<dim> &x,
              double spacing);

  /// The cell of lattice point k. Throws core::InputError where material is thinner than the
  /// particles can fill, so that a cell would reach through a void.
  ClippedCell(const Lattice<dim> &lattice, const SpecimenShape<dim> &shape,
              const LatticeIndex<dim> &k);

  /// Whether a part is not closed by neighbours and surfaces, or lies behind a void.
  bool reaches_through(const SpecimenShape<dim> &shape, const Vector<dim> &x, double spacing) const;

  double volume = 0;    // m^dim
  double radius = 0;    // m, of the farthest corner in the material
  bool is_open = false; // a part of the start cube is left
  std::vector<Part> parts;
  /// Smallest box around the cell, about the centre, in m.
  Vector<dim> lower = Vector<dim>::Constant(1e300), upper = -lower;
};

/// Volume and volume times centroid (about the centre) of what the voids leave of a cell around x.
template <int dim>
std::pair<double, Vector<dim>> clipped_volume(const VoronoiCell<dim> &cell,
                                              const SpecimenShape<dim> &shape, const Vector<dim> &x,
                                              double spacing);
} // namespace ligament::packings
