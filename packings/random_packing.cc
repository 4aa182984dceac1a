#include "packings/random_packing.h"

#include "core/check.h"
#include "packings/periodic_sides.h"
#include "packings/relaxation.h"
#include "packings/seed_packer.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace ligament::packings
{
namespace
{
/// Those that bound the cells of the packing.
template <int dim>
Seeds<dim> met_seeds(const SeedPacker<dim> &packer)
{
  const Seeds<dim> &seeds = packer.seeds();
  Seeds<dim> kept;
  for (int i = 0; i < seeds.size(); ++i)
    if (packer.is_met(i))
      kept.add(seeds.centre[i], seeds.radius[i], seeds.id[i]);
  return kept;
}

template <int dim>
RandomPacking<dim> pack_whole(const SpecimenParameters<dim> &specimen, Seeds<dim> seeds)
{
  SeedPacker<dim> packer(specimen, std::move(seeds));
  std::vector<int> all(packer.seeds().size());
  std::iota(all.begin(), all.end(), 0);
  packer.cut(all);
  core::require(packer.n_kept() > 0, no_whole_particle);
  RandomPacking<dim> random;
  for (int k = 0; k < packer.n_kept(); ++k)
    random.n_healed += packer.is_healed(packer.kept(k));
  random.packing = packer.take_packing();
  random.seeds = met_seeds(packer);
  return random;
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
  const auto all = pack_whole<dim>(wide, box.with_images(seeds, margin_of(size)));
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
  return pack_relaxed_seeds(specimen, std::move(seeds));
}

template <int dim>
RandomPacking<dim> pack_relaxed_seeds(const SpecimenParameters<dim> &specimen, Seeds<dim> seeds)
{
  if (const PeriodicBox<dim> box(specimen); box.is_any())
    return pack_periodic(specimen, box, sorted_by_id(std::move(seeds)));
  return pack_whole<dim>(specimen, std::move(seeds));
}

template <int dim>
Seeds<dim> make_random_seeds(const RandomParameters<dim> &p, const core::Ranks &ranks)
{
  core::require(p.size_ratio >= 1 && p.size_ratio <= 5,
                "the size ratio of a random packing must lie between 1 and 5");
  core::require(p.relaxation_sweeps >= 0, "the number of relaxation sweeps must not be negative");
  if (const PeriodicBox<dim> box(p); box.is_any())
    return relaxed_periodic_seeds<dim>(p, box, p.seed, p.size_ratio, p.relaxation_sweeps);
  return relaxed_seeds<dim>(SpecimenShape<dim>(p), p.spacing, p.seed, p.size_ratio,
                            p.relaxation_sweeps, p.zone_lower, p.zone_upper, ranks);
}

template <int dim>
RandomPacking<dim> make_random_packing(const RandomParameters<dim> &p)
{
  return pack_relaxed_seeds<dim>(p, make_random_seeds(p));
}

template Seeds<2> make_random_seeds(const RandomParameters<2> &, const core::Ranks &);
template Seeds<3> make_random_seeds(const RandomParameters<3> &, const core::Ranks &);
template RandomPacking<2> make_random_packing(const RandomParameters<2> &);
template RandomPacking<3> make_random_packing(const RandomParameters<3> &);
template RandomPacking<2> pack_seeds(const SpecimenParameters<2> &, Seeds<2>);
template RandomPacking<3> pack_seeds(const SpecimenParameters<3> &, Seeds<3>);
template RandomPacking<2> pack_relaxed_seeds(const SpecimenParameters<2> &, Seeds<2>);
template RandomPacking<3> pack_relaxed_seeds(const SpecimenParameters<3> &, Seeds<3>);
} // namespace ligament::packings
