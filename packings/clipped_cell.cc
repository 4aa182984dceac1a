#include "packings/clipped_cell.h"

#include "core/check.h"
#include "packings/seeds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::packings
{
namespace
{
template <int dim>
struct PartSum
{
  int id;
  Vector<dim> normal;
  double distance;
  double area;
  Vector<dim> moment;
  std::vector<Vector<dim>> corners; // empty where it has several pieces
};

constexpr bool is_side(int id)
{
  return id <= first_side_plane && id > first_void_plane;
}

constexpr bool is_facet(int id)
{
  return id <= first_facet;
}

/// What of a convex cell around x belongs to the solid.
template <int dim>
SolidPiece<dim> in_solid(const VoronoiCell<dim> &convex, const SpecimenShape<dim> &shape,
                         const Vector<dim> &x, double spacing)
{
  SolidPiece<dim> piece = shape.pieces->around(x);
  for (const auto &face : convex.faces())
    piece.clip(face.normal, face.distance, face.id, 1e-13 * spacing);
  return piece;
}

/// The face of the cell in whose plane the facet lies and that looks the other way; null: none.
template <int dim>
const typename VoronoiCell<dim>::Face *
opposite(const std::vector<typename VoronoiCell<dim>::Face> &faces,
         const typename SolidPiece<dim>::Face &facet, double spacing)
{
  for (const auto &face : faces)
    if ((face.normal + facet.normal).norm() < 1e-10 &&
        std::abs(face.distance + facet.distance) < 1e-10 * spacing)
      return &face;
  return nullptr;
}

template <int dim>
bool is_near_solid(const VoronoiCell<dim> &cell, const SpecimenShape<dim> &shape,
                   const Vector<dim> &x)
{
  const double reach = 4 * shape.spacing;
  return shape.solid && shape.solid->distance(x, reach) < std::min(reach, cell.max_radius());
}

/// The Voronoi cell of all kept lattice points and the flat sides of the specimen.
template <int dim>
VoronoiCell<dim> voronoi_cell(const Lattice<dim> &lattice, const SpecimenShape<dim> &shape,
                              const LatticeIndex<dim> &k)
{
  const double d = lattice.spacing;
  const Vector<dim> x = lattice.position(k);
  VoronoiCell<dim> cell(4 * d, start_plane, 1e-13 * d);
  clip_by_sides(cell, shape, x);
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

/// Calls visit(part, sign) for convex parts whose signed sum is the cell without the union of the
/// voids: inclusion and exclusion of every set of voids, from number `first` on, that meets in it.
template <int dim, typename Visit>
void for_each_convex_part(const VoronoiCell<dim> &cell, const SpecimenShape<dim> &shape,
                          const Vector<dim> &x, double spacing, Visit &&visit, int first = 0,
                          double sign = 1)
{
  if (first == 0)
    visit(cell, sign);
  // The polygon of a hole reaches a little out of its circle.
  const double reach = cell.max_radius() + 0.1 * spacing;
  for (const int v : shape.grid.within(x, reach)) {
    if (v < first || shape.voids[v].distance(x) > reach)
      continue;
    VoronoiCell<dim> common = cell;
    int side_id = first_void_plane - shape.n_sides_before[v];
    for (const HalfSpace<dim> &side : shape.voids[v].sides)
      common.clip(side.normal, side.offset - side.normal.dot(x), side_id--);
    if (common.is_empty())
      continue;
    visit(common, -sign);
    for_each_convex_part(common, shape, x, spacing, visit, v + 1, -sign);
  }
}
} // namespace

template <int dim>
void clip_by_sides(VoronoiCell<dim> &cell, const SpecimenShape<dim> &shape, const Vector<dim> &x)
{
  // A solid has facets there, which round-off must not take for what lies outside.
  const double off = shape.solid ? 1e-3 * shape.spacing : 0;
  for (int a = 0; a < dim; ++a) {
    cell.clip(-Vector<dim>::Unit(a), x[a] - shape.lower[a] + off, first_side_plane - 2 * a);
    cell.clip(Vector<dim>::Unit(a), shape.upper[a] - x[a] + off, first_side_plane - 2 * a - 1);
  }
}

template <int dim>
std::pair<double, Vector<dim>> clipped_volume(const VoronoiCell<dim> &cell,
                                              const SpecimenShape<dim> &shape, const Vector<dim> &x,
                                              double spacing)
{
  std::pair<double, Vector<dim>> sum{0, Vector<dim>::Zero()};
  const bool near_solid = is_near_solid(cell, shape, x);
  for_each_convex_part(cell, shape, x, spacing, [&](const VoronoiCell<dim> &part, double sign) {
    if (!near_solid) {
      sum.first += sign * part.volume();
      sum.second += sign * part.moment();
      return;
    }
    for (const auto &face : in_solid(part, shape, x, spacing).faces()) {
      sum.first += sign * face.area * face.distance / dim;
      sum.second += sign * face.distance / (dim + 1) * face.moment;
    }
  });
  return sum;
}

template <int dim>
ClippedCell<dim>::ClippedCell(const VoronoiCell<dim> &cell, const SpecimenShape<dim> &shape,
                              const Vector<dim> &x, double spacing)
{
  std::vector<PartSum<dim>> sums;
  const bool near_solid = is_near_solid(cell, shape, x);
  const auto add = [&](int id, const Vector<dim> &normal, double distance, double area,
                       const Vector<dim> &moment) {
    auto sum = std::find_if(sums.begin(), sums.end(), [&](const auto &s) { return s.id == id; });
    const bool is_first = sum == sums.end();
    if (is_first)
      sum = sums.insert(sum, {id, normal, distance, 0, Vector<dim>::Zero(), {}});
    sum->area += area;
    sum->moment += moment;
    volume += area * distance / dim;
    return std::pair(sum, is_first);
  };
  for_each_convex_part(cell, shape, x, spacing, [&](const VoronoiCell<dim> &convex, double sign) {
    SolidPiece<dim> piece;
    if (near_solid) {
      piece = in_solid(convex, shape, x, spacing);
      const auto faces = piece.faces();
      const auto cuts = convex.faces();
      for (std::size_t k = 0; k < faces.size(); ++k) {
        const auto &face = faces[k];
        // A facet of the neighbour's material in the plane between both: what lies there is the
        // void, and the cut has closed a sheet of no thickness with it.
        if (is_facet(face.id))
          if (const auto *cut = opposite<dim>(cuts, face, spacing)) {
            add(cut->id, cut->normal, cut->distance, -sign * face.area, -sign * face.moment);
            continue;
          }
        const auto [sum, is_first] =
            add(face.id, face.normal, face.distance, sign * face.area, sign * face.moment);
        if (dim == 3 && is_facet(face.id))
          sum->corners = is_first && sign > 0 ? piece.corners(k) : std::vector<Vector<dim>>();
      }
    } else {
      const auto faces = convex.faces();
      for (std::size_t k = 0; k < faces.size(); ++k) {
        const auto &face = faces[k];
        const auto [sum, is_first] = add(face.id, face.normal, face.distance, sign * face.area,
                                         sign * face.area * face.centroid);
        if (dim == 3 && is_side(face.id))
          sum->corners = is_first && sign > 0 ? convex.corners(k) : std::vector<Vector<dim>>();
      }
    }
    // Corners inside a void bound nothing.
    const std::vector<int> &near = shape.grid.within(x, convex.max_radius() + 0.1 * spacing);
    for (const Vector<dim> &corner : near_solid ? piece.vertices() : convex.vertices())
      if (std::none_of(near.begin(), near.end(),
                       [&](int v) { return shape.voids[v].contains(x + corner, 1e-9 * spacing); }))
      {
        lower = lower.cwiseMin(corner);
        upper = upper.cwiseMax(corner);
        radius = std::max(radius, corner.norm());
      }
  });
  for (PartSum<dim> &sum : sums) {
    if (std::abs(sum.area) < 1e-12 * std::pow(spacing, dim - 1))
      continue;
    if (sum.id >= 0)
      parts.push_back({sum.id, -1, sum.normal, sum.distance, sum.area, sum.moment});
    else if (sum.id == start_plane || sum.id == border_of_piece)
      is_open = true;
    else if (shape.solid &&
             is_facet(sum.id)) // its plane may be the one of a neighbour's facet, but not its name
      parts.push_back({-1, shape.solid->facets()[first_facet - sum.id].boundary, sum.normal,
                       sum.distance, sum.area, sum.moment, std::move(sum.corners)});
    else if (sum.id > first_void_plane)
      parts.push_back({-1, first_side_plane - sum.id, sum.normal, sum.distance, sum.area,
                       sum.moment, std::move(sum.corners)});
    else // area and moment of what was taken away are negative, the normal leads out of the void
      parts.push_back({-1, inner_surface<dim>, -sum.normal, -sum.distance, -sum.area, -sum.moment});
  }
}

template <int dim>
bool ClippedCell<dim>::reaches_through(const SpecimenShape<dim> &shape, const Vector<dim> &x,
                                       double spacing) const
{
  // Round a corner the line of sight dips less deep into a void, which is at least d wide.
  for (const Part &part : parts) {
    const Vector<dim> there = x + part.moment / part.area;
    for (const int v : shape.grid.within(x, (there - x).norm() + spacing))
      if (shape.voids[v].hides(x, there, 0.45 * spacing))
        return true;
    if (shape.leaves_solid(x, there, 0.45 * spacing))
      return true;
  }
  return is_open;
}

template <int dim>
ClippedCell<dim>::ClippedCell(const Lattice<dim> &lattice, const SpecimenShape<dim> &shape,
                              const LatticeIndex<dim> &k)
    : ClippedCell(voronoi_cell(lattice, shape, k), shape, lattice.position(k), lattice.spacing)
{
  // All who compete for a point within 3 d of this particle lie within reach, so up to there cells
  // are true. Farther points, or points behind a void, are material without particles of its own.
  const double d = lattice.spacing;
  const Vector<dim> x = lattice.position(k);
  core::require(radius <= 3 * d && !reaches_through(shape, x, d),
                fmt::format("near {} the specimen is thinner, or a corner of it sharper, than the "
                            "particles of a lattice can fill: make the spacing smaller, blunt the "
                            "corner, let a hole or notch reach through the surface, or choose the "
                            "packing \"random\"",
                            place_text<dim>(x)));
}

template void clip_by_sides(VoronoiCell<2> &, const SpecimenShape<2> &, const Vector<2> &);
template void clip_by_sides(VoronoiCell<3> &, const SpecimenShape<3> &, const Vector<3> &);
template std::pair<double, Vector<2>>
clipped_volume(const VoronoiCell<2> &, const SpecimenShape<2> &, const Vector<2> &, double);
template std::pair<double, Vector<3>>
clipped_volume(const VoronoiCell<3> &, const SpecimenShape<3> &, const Vector<3> &, double);
template struct ClippedCell<2>;
template struct ClippedCell<3>;
} // namespace ligament::packings
