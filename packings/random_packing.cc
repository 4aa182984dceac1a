#include "packings/random_packing.h"

#include "core/check.h"
#include "packings/clipped_cell.h"
#include "packings/periodic_sides.h"
#include "packings/power_diagram.h"
#include "packings/relaxation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ligament::packings
{
namespace
{
template <int dim>
std::string place_text(const Vector<dim> &x)
{
  std::string text = fmt::format("{:.6g}", x[0]);
  for (int a = 1; a < dim; ++a)
    text += fmt::format(", {:.6g}", x[a]);
  return text;
}

template <int dim>
Seeds<dim> sorted_by_id(const Seeds<dim> &seeds)
{
  std::vector<int> order(seeds.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return seeds.id[a] < seeds.id[b]; });
  Seeds<dim> sorted;
  for (const int i : order)
    sorted.add(seeds.centre[i], seeds.radius[i], seeds.id[i]);
  return sorted;
}

/// Heals the radii; returns those before.
template <int dim>
std::vector<double> healed(Seeds<dim> &seeds, double bin)
{
  const std::vector<double> before = seeds.radius;
  heal_radii(seeds, bin);
  return before;
}

template <int dim>
class Packer
{
public:
  Packer(const SpecimenParameters<dim> &parameters, Seeds<dim> seeds);
  RandomPacking<dim> pack();

private:
  using Part = typename ClippedCell<dim>::Part;

  ClippedCell<dim> cell_of(int seed) const;
  bool is_in_zone(const Vector<dim> &lower, const Vector<dim> &upper) const;
  void place_particles();
  void join_faces();
  void keep_seeds();

  const SpecimenShape<dim> shape_;
  const double spacing_, thickness_;
  Vector<dim> zone_lower_, zone_upper_;     // infinite where the side is not coupled
  const core::BoxUnion<dim> parts_of_zone_; // empty: all of it
  Seeds<dim> seeds_;
  const std::vector<double> given_radius_; // before healing
  const PowerDiagram<dim> diagram_;

  std::vector<int> particle_of_; // seed -> particle or -1
  std::vector<int> seed_of_;     // particle -> seed
  std::vector<Part> parts_;      // of all particles in turn
  std::vector<int> first_part_ = {0};
  Packing<dim> packing_;
};

template <int dim>
double bin_size(double spacing)
{
  return std::pow(mean_cell_volume<dim>(spacing), 1. / dim);
}

template <int dim>
Packer<dim>::Packer(const SpecimenParameters<dim> &p, Seeds<dim> seeds)
    : shape_(p), spacing_(p.spacing), thickness_(dim == 2 ? p.thickness : 1),
      parts_of_zone_(p.zone_parts), seeds_(sorted_by_id(seeds)),
      given_radius_(healed(seeds_, bin_size<dim>(p.spacing))),
      diagram_(seeds_, bin_size<dim>(p.spacing)), particle_of_(seeds_.size(), -1)
{
  for (int a = 0; a < dim; ++a) {
    const double tolerance = 1e-9 * spacing_;
    zone_lower_[a] = p.zone_lower[a] > p.lower[a] + tolerance ? p.zone_lower[a] : -1e300;
    zone_upper_[a] = p.zone_upper[a] < p.upper[a] - tolerance ? p.zone_upper[a] : 1e300;
  }
  packing_.spacing = spacing_;
  packing_.thickness = thickness_;
}

template <int dim>
ClippedCell<dim> Packer<dim>::cell_of(int i) const
{
  VoronoiCell<dim> cell(start_half_width * spacing_, start_plane, 1e-13 * spacing_);
  clip_by_sides(cell, shape_, seeds_.centre[i]);
  diagram_.cut(cell, i);
  return {cell, shape_, seeds_.centre[i], spacing_};
}

template <int dim>
bool Packer<dim>::is_in_zone(const Vector<dim> &lower, const Vector<dim> &upper) const
{
  const double tolerance = 1e-9 * spacing_;
  return ((lower - zone_lower_).array() >= -tolerance).all() &&
         ((zone_upper_ - upper).array() >= -tolerance).all() &&
         (parts_of_zone_.boxes.empty() || parts_of_zone_.covers(lower, upper, tolerance));
}

template <int dim>
void Packer<dim>::place_particles()
{
  for (int i = 0; i < seeds_.size(); ++i) {
    const Vector<dim> &x = seeds_.centre[i];
    if (!is_in_zone(x, x))
      continue;
    const ClippedCell<dim> cell = cell_of(i);
    if (!is_in_zone(x + cell.lower, x + cell.upper))
      continue;
    core::require(
        !cell.reaches_through(shape_, x, spacing_),
        fmt::format("the cell of the particle at ({}) is not closed, or reaches through a hole or "
                    "notch: the seeds are too sparse there, or the specimen is thinner than the "
                    "particles can fill; make the spacing smaller",
                    place_text<dim>(x)));
    particle_of_[i] = packing_.size();
    seed_of_.push_back(i);
    packing_.volume.push_back(cell.volume * thickness_);
    packing_.diameter.push_back(2 * seeds_.radius[i]);
    packing_.global_id.push_back(seeds_.id[i]);
    for (int a = 0; a < dim; ++a)
      packing_.centre[a].push_back(x[a]);
    parts_.insert(parts_.end(), cell.parts.begin(), cell.parts.end());
    first_part_.push_back(int(parts_.size()));
  }
}

template <int dim>
void Packer<dim>::join_faces()
{
  std::vector<Part> own;
  for (int i = 0; i < packing_.size(); ++i) {
    own.assign(parts_.begin() + first_part_[i], parts_.begin() + first_part_[i + 1]);
    std::sort(own.begin(), own.end(),
              [](const Part &a, const Part &b) { return a.neighbour < b.neighbour; });
    const Vector<dim> &x = seeds_.centre[seed_of_[i]];
    for (const Part &part : own) {
      const Vector<dim> lever = part.moment / part.area;
      const double area = part.area * thickness_;
      if (part.neighbour < 0) {
        packing_.boundary_faces.push_back(
            {i, part.normal, area, part.distance, lever, part.boundary, part.corners});
        continue;
      }
      const int j = particle_of_[part.neighbour];
      if (j <= i) // made by j, or left out
        continue;
      const Vector<dim> &y = seeds_.centre[part.neighbour];
      packing_.faces.push_back({i, j, part.normal, area, part.distance,
                                (y - x).norm() - part.distance, lever, lever - (y - x), -1, false});
    }
  }
}

/// Keeps those that bound the cells.
template <int dim>
void Packer<dim>::keep_seeds()
{
  std::vector<char> bounds(seeds_.size(), 0);
  for (const int i : seed_of_)
    bounds[i] = 1;
  for (const Part &part : parts_)
    if (part.neighbour >= 0)
      bounds[part.neighbour] = 1;
  Seeds<dim> kept;
  for (int i = 0; i < seeds_.size(); ++i)
    if (bounds[i])
      kept.add(seeds_.centre[i], seeds_.radius[i], seeds_.id[i]);
  seeds_ = std::move(kept);
}

template <int dim>
RandomPacking<dim> Packer<dim>::pack()
{
  place_particles();
  core::require(packing_.size() > 0,
                "the discrete zone holds no whole particle: widen it or make the spacing smaller");
  join_faces();
  cut_faces(packing_, shape_.cracks);
  int n_healed = 0;
  for (const int i : seed_of_)
    n_healed += seeds_.radius[i] < given_radius_[i];
  keep_seeds();
  return {std::move(packing_), std::move(seeds_), n_healed};
}

template <int dim>
void check_seeds(const SpecimenShape<dim> &shape, const Seeds<dim> &seeds)
{
  for (int i = 0; i < seeds.size(); ++i)
    core::require(shape.distance(seeds.centre[i]) > 0 && seeds.radius[i] > 0,
                  fmt::format("particle {} at ({}) lies outside the material or has no radius",
                              i + 1, place_text<dim>(seeds.centre[i])));
}

/// Diameter of the largest one.
template <int dim>
double largest_size(const Seeds<dim> &seeds, double spacing)
{
  double size = spacing;
  for (const double radius : seeds.radius)
    size = std::max(size, 2 * radius);
  return size;
}

/// Of seeds and their images beyond the joined sides.
template <int dim>
RandomPacking<dim> pack_periodic(const SpecimenParameters<dim> &specimen,
                                 const PeriodicBox<dim> &box, const Seeds<dim> &seeds)
{
  const double size = largest_size(seeds, specimen.spacing);
  const auto wide = widened(specimen, box, size);
  const int n_seeds = seeds.size();
  // The seeds come first: image number 0 is their own.
  std::vector<std::array<int, dim>> images = {std::array<int, dim>{}};
  box.for_each_image(margin_of(size), [&](const std::array<int, dim> &n) { images.push_back(n); });
  const auto all = Packer<dim>(wide, box.with_images(seeds, margin_of(size))).pack();
  RandomPacking<dim> random;
  random.packing = folded<dim>(all.packing, box, [&](int i) {
    const std::int64_t id = all.packing.global_id[i];
    return ImageOf<dim>{seeds.id[id % n_seeds], images[id / n_seeds]};
  });
  std::vector<char> bounds(n_seeds, 0);
  for (const std::int64_t id : all.seeds.id)
    bounds[id % n_seeds] = 1;
  for (int s = 0; s < n_seeds; ++s)
    if (bounds[s])
      random.seeds.add(seeds.centre[s], seeds.radius[s], seeds.id[s]);
  for (int i = 0; i < all.packing.size(); ++i)
    if (const std::int64_t s = all.packing.global_id[i]; s < n_seeds) {
      random.n_healed += all.packing.diameter[i] < 2 * seeds.radius[s];
      random.seeds
          .radius[std::lower_bound(random.seeds.id.begin(), random.seeds.id.end(), seeds.id[s]) -
                  random.seeds.id.begin()] = all.packing.diameter[i] / 2;
    }
  return random;
}
} // namespace

template <int dim>
RandomPacking<dim> pack_seeds(const SpecimenParameters<dim> &specimen, Seeds<dim> seeds)
{
  check_seeds(SpecimenShape<dim>(specimen), seeds);
  if (const PeriodicBox<dim> box(specimen); box.is_any())
    return pack_periodic(specimen, box, sorted_by_id(seeds));
  return Packer<dim>(specimen, std::move(seeds)).pack();
}

template <int dim>
RandomPacking<dim> make_random_packing(const RandomParameters<dim> &p)
{
  core::require(p.size_ratio >= 1 && p.size_ratio <= 5,
                "the size ratio of a random packing must lie between 1 and 5");
  core::require(p.relaxation_sweeps >= 0, "the number of relaxation sweeps must not be negative");
  if (const PeriodicBox<dim> box(p); box.is_any())
    return pack_periodic(
        p, box, relaxed_periodic_seeds<dim>(p, box, p.seed, p.size_ratio, p.relaxation_sweeps));
  const SpecimenShape<dim> shape(p);
  return Packer<dim>(p, relaxed_seeds<dim>(shape, p.spacing, p.seed, p.size_ratio,
                                           p.relaxation_sweeps, p.zone_lower, p.zone_upper))
      .pack();
}

template RandomPacking<2> make_random_packing(const RandomParameters<2> &);
template RandomPacking<3> make_random_packing(const RandomParameters<3> &);
template RandomPacking<2> pack_seeds(const SpecimenParameters<2> &, Seeds<2>);
template RandomPacking<3> pack_seeds(const SpecimenParameters<3> &, Seeds<3>);
} // namespace ligament::packings
