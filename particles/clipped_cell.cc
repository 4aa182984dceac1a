#include "particles/clipped_cell.h"

#include "core/check.h"
#include "particles/voronoi_cell.h"

#include <algorithm>
#include <cmath>

namespace ligament::particles
{
namespace
{
/// Numbers for the planes that bound a cell: from 0 the neighbours, in Lattice::reachable; below 0
/// the start cube, the sides of the specimen, and the sides of the voids.
constexpr int start_id = -1, first_side_id = -10, first_void_id = -100;

template <int dim>
struct PartSum
{
  int id;
  Vector<dim> normal;
  double distance;
  double area;
  Vector<dim> moment;
};

/// The Voronoi cell of all kept lattice points and the flat sides of the specimen.
template <int dim>
VoronoiCell<dim> voronoi_cell(const Lattice<dim> &lattice, const SpecimenShape<dim> &shape,
                              const LatticeIndex<dim> &k)
{
  const double d = lattice.spacing;
  const Vector<dim> x = lattice.position(k);
  VoronoiCell<dim> cell(4 * d, start_id, 1e-13 * d);
  for (int a = 0; a < dim; ++a) {
    cell.clip(-Vector<dim>::Unit(a), x[a] - shape.lower[a], first_side_id - 2 * a);
    cell.clip(Vector<dim>::Unit(a), shape.upper[a] - x[a], first_side_id - 2 * a - 1);
  }
  for (std::size_t n = 0; n < lattice.reachable.size(); ++n) {
    const LatticeNeighbour<dim> &other = lattice.reachable[n];
    if (other.distance / 2 > cell.max_radius())
      break;
    if (cell.is_cut_by(other.direction, other.distance / 2) &&
        is_kept(shape, lattice.position(k + other.offset), d))
      cell.clip(other.direction, other.distance / 2, int(n));
  }
  return cell;
}

/// Sums faces, volume and corners of a cell around x and of what voids take from it.
template <int dim>
struct CellSum
{
  const SpecimenShape<dim> &shape;
  const Vector<dim> x;
  const double spacing;
  double volume = 0;
  double radius = 0; // of the farthest corner in the material
  Vector<dim> lower = Vector<dim>::Constant(1e300), upper = -lower;
  std::vector<PartSum<dim>> parts = {};

  void add(const VoronoiCell<dim> &cell, double sign)
  {
    for (const auto &face : cell.faces()) {
      auto part =
          std::find_if(parts.begin(), parts.end(), [&](const auto &p) { return p.id == face.id; });
      if (part == parts.end())
        part = parts.insert(part, {face.id, face.normal, face.distance, 0, Vector<dim>::Zero()});
      part->area += sign * face.area;
      part->moment += sign * face.area * face.centroid;
      volume += sign * face.area * face.distance / dim;
    }
    // Corners inside a void bound nothing.
    for (const Vector<dim> &corner : cell.vertices())
      if (std::none_of(shape.voids.begin(), shape.voids.end(),
                       [&](const auto &v) { return v.contains(x + corner, 1e-9 * spacing); }))
      {
        lower = lower.cwiseMin(corner);
        upper = upper.cwiseMax(corner);
        radius = std::max(radius, corner.norm());
      }
  }

  /// Takes the union of the voids away by inclusion and exclusion: every set of voids, from number
  /// `first` on, that meets in the cell.
  void subtract_voids(const VoronoiCell<dim> &cell, std::size_t first, double sign)
  {
    int id = first_void_id;
    for (std::size_t v = 0; v < shape.voids.size(); id -= int(shape.voids[v++].sides.size())) {
      // The polygon of a hole reaches a little out of its circle.
      if (v < first || shape.voids[v].distance(x) > cell.max_radius() + 0.1 * spacing)
        continue;
      VoronoiCell<dim> common = cell;
      int side_id = id;
      for (const HalfSpace<dim> &side : shape.voids[v].sides)
        common.clip(side.normal, side.offset - side.normal.dot(x), side_id--);
      if (common.is_empty())
        continue;
      add(common, -sign);
      subtract_voids(common, v + 1, -sign);
    }
  }
};
} // namespace

template <int dim>
ClippedCell<dim>::ClippedCell(const Lattice<dim> &lattice, const SpecimenShape<dim> &shape,
                              const LatticeIndex<dim> &k)
{
  const double d = lattice.spacing;
  const VoronoiCell<dim> cell = voronoi_cell(lattice, shape, k);
  CellSum<dim> sum{shape, lattice.position(k), d};
  sum.add(cell, 1);
  sum.subtract_voids(cell, 0, 1);
  volume = sum.volume;
  lower = sum.lower;
  upper = sum.upper;

  // All who compete for a point within 3 d of this particle lie within reach, so up to there cells
  // are true. Farther points, or points behind a void (which is at least d wide; round a corner the
  // line of sight dips less deep), are material without particles of its own.
  bool too_thin = sum.radius > 3 * d;
  for (const PartSum<dim> &part : sum.parts) {
    if (std::abs(part.area) < 1e-12 * lattice.face_area)
      continue;
    too_thin = too_thin || part.id == start_id;
    for (const Void<dim> &v : shape.voids)
      too_thin = too_thin || v.hides(sum.x, sum.x + part.moment / part.area, 0.45 * d);
    if (part.id >= 0)
      parts.push_back({part.id, -1, part.normal, part.distance, part.area, part.moment});
    else if (part.id > first_void_id)
      parts.push_back(
          {-1, first_side_id - part.id, part.normal, part.distance, part.area, part.moment});
    else // area and moment of what was taken away are negative, the normal leads out of the void
      parts.push_back(
          {-1, inner_surface<dim>, -part.normal, -part.distance, -part.area, -part.moment});
  }
  core::require(!too_thin,
                "beside a hole or notch the specimen is thinner than the particles can fill: make "
                "the spacing smaller, or let the hole or notch reach through the surface");
}

template struct ClippedCell<2>;
template struct ClippedCell<3>;
} // namespace ligament::particles
