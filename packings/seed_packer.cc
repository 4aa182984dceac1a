#include "packings/seed_packer.h"

#include "core/check.h"
#include "packings/relaxation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::packings
{
namespace
{
/// Heals the radii; returns those before.
template <int dim>
std::vector<double> healed(Seeds<dim> &seeds, double bin, const core::Ranks &ranks)
{
  const std::vector<double> before = seeds.radius;
  heal_radii(seeds, bin, ranks);
  return before;
}

/// Merges what came last, from number `first` on, into the order of the seeds.
template <typename T, typename SeedOf>
void merge_from(std::size_t first, std::vector<T> &values, SeedOf &&seed_of)
{
  std::inplace_merge(values.begin(), values.begin() + std::ptrdiff_t(first), values.end(),
                     [&](const T &a, const T &b) { return seed_of(a) < seed_of(b); });
}
} // namespace

template <int dim>
SeedPacker<dim>::SeedPacker(const SpecimenParameters<dim> &p, Seeds<dim> seeds,
                            const core::Ranks &ranks)
    : shape_(p), spacing_(p.spacing), thickness_(dim == 2 ? p.thickness : 1),
      parts_of_zone_(p.zone_parts), seeds_(sorted_by_id(std::move(seeds))),
      given_radius_(healed(seeds_, mean_distance<dim>(p.spacing), ranks)),
      diagram_(seeds_, mean_distance<dim>(p.spacing)), is_met_(seeds_.size(), 0)
{
  for (int a = 0; a < dim; ++a) {
    const double tolerance = 1e-9 * spacing_;
    zone_lower_[a] = p.zone_lower[a] > p.lower[a] + tolerance ? p.zone_lower[a] : -1e300;
    zone_upper_[a] = p.zone_upper[a] < p.upper[a] - tolerance ? p.zone_upper[a] : 1e300;
  }
}

template <int dim>
ClippedCell<dim> SeedPacker<dim>::cell_of(int i) const
{
  VoronoiCell<dim> cell(start_half_width * spacing_, start_plane, 1e-13 * spacing_);
  clip_by_sides(cell, shape_, seeds_.centre[i]);
  diagram_.cut(cell, i);
  return {cell, shape_, seeds_.centre[i], spacing_};
}

template <int dim>
bool SeedPacker<dim>::is_in_zone(const Vector<dim> &lower, const Vector<dim> &upper) const
{
  const double tolerance = 1e-9 * spacing_;
  return ((lower - zone_lower_).array() >= -tolerance).all() &&
         ((zone_upper_ - upper).array() >= -tolerance).all() &&
         (parts_of_zone_.boxes.empty() || parts_of_zone_.covers(lower, upper, tolerance));
}

// No cell reaches beyond the cube that it is cut from.
template <int dim>
auto SeedPacker<dim>::place_in_zone(int i) const -> InZone
{
  const Vector<dim> &x = seeds_.centre[i],
                    most = Vector<dim>::Constant(start_half_width * spacing_);
  if (!is_in_zone(x, x))
    return InZone::no;
  return is_in_zone(x - most, x + most) ? InZone::yes : InZone::maybe;
}

template <int dim>
bool SeedPacker<dim>::has_particle(int i) const
{
  const InZone place = place_in_zone(i);
  if (place != InZone::maybe)
    return place == InZone::yes;
  const ClippedCell<dim> cell = cell_of(i);
  return is_in_zone(seeds_.centre[i] + cell.lower, seeds_.centre[i] + cell.upper);
}

template <int dim>
void SeedPacker<dim>::cut(const std::vector<int> &seeds)
{
  constexpr std::size_t faces_per_cell = dim == 2 ? 3 : 8; // about: memory comes in one piece
  const std::size_t n_kept = kept_.size(), n_faces = faces_.size(),
                    n_boundary = boundary_faces_.size();
  faces_.reserve(n_faces + faces_per_cell * seeds.size());
  for (const int i : seeds) {
    const Vector<dim> &x = seeds_.centre[i];
    if (!is_in_zone(x, x))
      continue;
    const ClippedCell<dim> cell = cell_of(i);
    if (is_in_zone(x + cell.lower, x + cell.upper))
      keep(i, cell);
  }
  merge_from(n_kept, kept_, [](const Kept &k) { return k.seed; });
  merge_from(n_faces, faces_, [](const Face<dim> &f) { return f.i; });
  merge_from(n_boundary, boundary_faces_, [](const BoundaryFace<dim> &f) { return f.i; });
}

// A face between two is made by the first of them.
template <int dim>
void SeedPacker<dim>::keep(int i, const ClippedCell<dim> &cell)
{
  using Part = typename ClippedCell<dim>::Part;
  const Vector<dim> &x = seeds_.centre[i];
  if (cell.reaches_through(shape_, x, spacing_))
    throw core::InputError(fmt::format(
        "the cell of the particle at ({}) is not closed, or reaches through a hole or notch: the "
        "seeds are too sparse there, or the specimen is thinner than the particles can fill; make "
        "the spacing smaller",
        place_text<dim>(x)));
  kept_.push_back({i, cell.volume * thickness_});
  is_met_[i] = 1;
  std::vector<Part> own = cell.parts;
  std::sort(own.begin(), own.end(),
            [](const Part &a, const Part &b) { return a.neighbour < b.neighbour; });
  for (Part &part : own) {
    const Vector<dim> lever = part.moment / part.area;
    const double area = part.area * thickness_;
    const int j = part.neighbour;
    if (j < 0) {
      boundary_faces_.push_back(
          {i, part.normal, area, part.distance, lever, part.boundary, std::move(part.corners)});
      continue;
    }
    is_met_[j] = 1;
    if (j < i)
      continue;
    const Vector<dim> r = seeds_.centre[j] - x;
    faces_.push_back({i, j, part.normal, area, part.distance, r.norm() - part.distance, lever,
                      lever - r, -1, false});
  }
}

template <int dim>
Packing<dim> SeedPacker<dim>::take_packing()
{
  Packing<dim> packing;
  packing.spacing = spacing_;
  packing.thickness = thickness_;
  std::vector<int> number(seeds_.size(), -1); // of a seed's particle
  for (const Kept &kept : kept_) {
    const int i = kept.seed;
    number[i] = packing.size();
    packing.volume.push_back(kept.volume);
    packing.diameter.push_back(2 * seeds_.radius[i]);
    packing.global_id.push_back(seeds_.id[i]);
    for (int a = 0; a < dim; ++a)
      packing.centre[a].push_back(seeds_.centre[i][a]);
  }
  faces_.erase(std::remove_if(faces_.begin(), faces_.end(),
                              [&](const Face<dim> &f) { return number[f.j] < 0; }),
               faces_.end());
  for (Face<dim> &face : faces_) {
    face.i = number[face.i];
    face.j = number[face.j];
  }
  for (BoundaryFace<dim> &face : boundary_faces_)
    face.i = number[face.i];
  packing.faces = std::move(faces_);
  packing.boundary_faces = std::move(boundary_faces_);
  kept_ = {};
  cut_faces(packing, shape_.cracks);
  return packing;
}

template class SeedPacker<2>;
template class SeedPacker<3>;
} // namespace ligament::packings
