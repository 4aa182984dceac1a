#include "src/simulation/make_packing.h"

#include "core/check.h"
#include "core/exact_sum.h"
#include "core/keyed_error.h"
#include "core/sums.h"
#include "packings/gathered_part.h"
#include "packings/packing_file.h"
#include "packings/random_part.h"
#include "packings/solid_piece.h"
#include "src/scene/body_shape.h"
#include "src/scene/geometry.h"
#include "src/simulation/make_force.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
using core::require;

namespace
{
template <int dim>
void set_specimen(const Scene &scene, packings::SpecimenParameters<dim> &p)
{
  p.spacing = scene.zone.spacing;
  p.thickness = scene.specimen.thickness;
  const Specimen &specimen = scene.specimen;
  p.lower = to_vector<dim>(specimen.lower());
  p.upper = to_vector<dim>(specimen.upper());
  for (int c = 0; c < dim; ++c)
    p.periodic[c] = specimen.is_periodic(c);
  p.solid = solid_of<dim>(specimen, p.spacing / 2);
  if (p.solid) { // whose straight sides in place of arcs reach out of the box a little
    p.lower = p.solid->lower();
    p.upper = p.solid->upper();
  }
  if (!p.solid)
    for (const auto &hole : specimen.holes)
      p.holes.push_back({to_vector<dim>(hole.centre), hole.radius});
  if (!p.solid || dim == 3)
    for (const auto &notch : specimen.notches)
      p.notches.push_back({to_vector<dim>(notch.lower), to_vector<dim>(notch.upper)});
  for (const auto &crack : specimen.cracks) {
    std::vector<Vector<dim>> points;
    for (const auto &point : crack.points)
      points.push_back(to_vector<dim>(point));
    if (dim == 3)
      p.cracks.push_back(points);
    else // one straight cut after the other
      for (std::size_t k = 1; k < points.size(); ++k)
        p.cracks.push_back({points[k - 1], points[k]});
  }
  if (scene.zone.extent != DiscreteZone::Extent::box)
    return;
  // The corners around all boxes; the default reaches through.
  const Vector<dim> through = p.zone_upper;
  p.zone_lower = through;
  p.zone_upper = -through;
  for (const auto &box : zone_shape<dim>(scene).boxes) {
    p.zone_lower = p.zone_lower.cwiseMin(box.lower).cwiseMax(-through);
    p.zone_upper = p.zone_upper.cwiseMax(box.upper).cwiseMin(through);
  }
  if (scene.zone.boxes.size() > 1)
    p.zone_parts = zone_shape<dim>(scene);
}
} // namespace

template <int dim>
packings::SpecimenParameters<dim> packed_specimen_of(const Scene &scene)
{
  packings::SpecimenParameters<dim> p;
  set_specimen<dim>(scene, p);
  return p;
}

template <int dim>
packings::LatticeParameters<dim> lattice_of(const Scene &scene)
{
  packings::LatticeParameters<dim> p;
  set_specimen<dim>(scene, p);
  p.kind = packings::lattice_kind(word_of(*scene.zone.packing));
  for (int c = 0; c < n_spins<dim>; ++c)
    p.orientation[c] = scene.zone.orientation[c];
  return p;
}

template <int dim>
packings::RandomParameters<dim> random_packing_of(const Scene &scene)
{
  packings::RandomParameters<dim> p;
  set_specimen<dim>(scene, p);
  p.seed = scene.zone.seed;
  p.relaxation_sweeps = scene.zone.relaxation_sweeps;
  p.size_ratio = scene.zone.size_ratio;
  return p;
}

double reach_of_overlap(const Scene &scene)
{
  const bool coupled = scene.far_field && scene.zone.extent == DiscreteZone::Extent::box;
  return coupled
             ? scene.coupling.overlap_cells * scene.far_field->cell_size + 2 * scene.zone.spacing
             : 0;
}

double mean_cell_volume(const Scene &scene)
{
  const double d = scene.zone.spacing, thickness = scene.specimen.thickness;
  if (scene.zone.is_irregular())
    return scene.dimension == 2 ? packings::mean_cell_volume<2>(d) * thickness
                                : packings::mean_cell_volume<3>(d);
  switch (*scene.zone.packing) {
  case PackingKind::square:
    return d * d * thickness;
  case PackingKind::hexagonal:
    return std::sqrt(3.) / 2 * d * d * thickness;
  case PackingKind::simple_cubic:
    return d * d * d;
  case PackingKind::fcc:
    return d * d * d / std::sqrt(2.);
  case PackingKind::bcc:
    return 4 / (3 * std::sqrt(3.)) * d * d * d;
  case PackingKind::random:
  case PackingKind::file:
    break;
  }
  return 0;
}

namespace
{
template <int dim>
packings::Seeds<dim> read_seeds(const Scene &scene)
{
  const auto refuse = [](const std::string &reason) {
    return core::KeyedError("/discrete_zone/packing_file",
                            "the \"packing_file\" in /discrete_zone cannot be used", reason,
                            "correct the file or its path; a run writes such a file, packing.csv");
  };
  try {
    return packings::read_packing_file<dim>(scene.zone.packing_file);
  } catch (const core::InputError &error) {
    throw refuse(error.what());
  } catch (const core::EnvironmentError &error) {
    throw refuse(error.what());
  }
}

/// Corners of the box around what of the body lies in the zone.
template <int dim>
std::pair<Vector<dim>, Vector<dim>> extent_in_zone(const packings::RandomParameters<dim> &p)
{
  Vector<dim> lower = p.lower.cwiseMax(p.zone_lower), upper = p.upper.cwiseMin(p.zone_upper);
  if (!p.solid)
    return {lower, upper};
  packings::SolidPiece<dim> piece(*p.solid, 0);
  for (int c = 0; c < dim; ++c) {
    piece.clip(Vector<dim>::Unit(c), upper[c], 0, 0);
    piece.clip(-Vector<dim>::Unit(c), -lower[c], 0, 0);
  }
  if (piece.vertices().empty())
    return {lower, upper};
  lower = upper = piece.vertices()[0];
  for (const Vector<dim> &x : piece.vertices()) {
    lower = lower.cwiseMin(x);
    upper = upper.cwiseMax(x);
  }
  return {lower, upper};
}

/// Cells reach to the next seed, however far: the file of a zone would fill a whole specimen badly.
template <int dim>
void require_cover(const Scene &scene, const packings::RandomParameters<dim> &p,
                   const packings::Seeds<dim> &seeds)
{
  Vector<dim> lower = seeds.centre[0], upper = lower;
  for (int i = 1; i < seeds.size(); ++i) {
    lower = lower.cwiseMin(seeds.centre[i]);
    upper = upper.cwiseMax(seeds.centre[i]);
  }
  const auto [body_lower, body_upper] = extent_in_zone(p);
  const double far = (p.solid ? 6 : 3) * p.spacing; // no seed lies in the tip of a sharp corner
  for (int c = 0; c < dim; ++c) {
    const double low = body_lower[c], high = body_upper[c];
    if (std::max(lower[c] - low, high - upper[c]) > far)
      throw core::KeyedError(
          "/discrete_zone/packing_file",
          fmt::format("the particles of {} do not fill the discrete zone in {}",
                      scene.zone.packing_file, "xyz"[c]),
          fmt::format("they go from {:.4g} m to {:.4g} m, the body there from {:.4g} m to {:.4g} m",
                      lower[c], upper[c], low, high),
          "give a file for this zone: that of a run with far field holds its zone alone, its pure "
          "discrete twin needs the packing of the whole specimen");
  }
}

/// Of an irregular packing: from its file, or drawn and relaxed, which ranks share.
template <int dim>
packings::Seeds<dim> find_seeds(const Scene &scene, Reference &reference,
                                const core::Ranks &ranks = {})
{
  return reference.seeds<dim>([&] {
    return scene.zone.packing == PackingKind::random
               ? packings::make_random_seeds(random_packing_of<dim>(scene), ranks)
               : read_seeds<dim>(scene);
  });
}

/// Equal radii give the same cells whatever they are, but contacts behind a break go by them.
template <int dim>
void require_radii_of_cells(const Scene &scene, const packings::Seeds<dim> &seeds)
{
  core::ExactSum sum;
  for (const double radius : seeds.radius)
    sum.add(std::pow(2 * radius / scene.zone.spacing, dim));
  const double size = std::pow(sum.value() / double(seeds.size()), 1. / dim);
  if (size > 0.5 && size < 2)
    return;
  throw core::KeyedError(
      "/discrete_zone/packing_file",
      "the radii of " + scene.zone.packing_file + " do not belong to its particles",
      fmt::format(
          "they are {:.3g} of half of \"spacing\" in the mean; fragments would touch at that "
          "distance",
          size),
      "check the unit of the column r, and \"spacing\" in /discrete_zone");
}

template <int dim>
packings::RandomPacking<dim> pack_file(const Scene &scene, packings::Seeds<dim> seeds)
{
  const auto parameters = random_packing_of<dim>(scene);
  const std::vector<int> material = std::move(seeds.material);
  seeds.material.clear();
  require_cover(scene, parameters, seeds);
  require_radii_of_cells(scene, seeds);
  auto packing = packings::pack_seeds<dim>(parameters, std::move(seeds));
  for (const auto row : packing.packing.global_id) // the name of a seed is the number of its row
    if (!material.empty())
      packing.packing.material.push_back(material[row]);
  for (const auto row : packing.seeds.id)
    if (!material.empty())
      packing.seeds.material.push_back(material[row]);
  const auto &cells = packing.packing.volume;
  const double volume =
      core::exact_sum(cells.size(), [&](std::size_t k) { return cells[k]; }).value();
  const double mean = volume / double(cells.size());
  const double ratio = std::pow(mean / mean_cell_volume(scene), 1. / dim);
  if (!(ratio > 0.9 && ratio < 1.1))
    throw core::KeyedError(
        "/discrete_zone/spacing",
        fmt::format("\"spacing\" in /discrete_zone is {} m, but that of the packing is {:.4g} m",
                    scene.zone.spacing, ratio * scene.zone.spacing),
        "the file says how large its particles are: " + scene.zone.packing_file,
        fmt::format("give {:.4g} m", ratio * scene.zone.spacing));
  return packing;
}

void report_healed(int n_healed, core::Log &log)
{
  if (n_healed > 0)
    log.info("{} radii made smaller, lest a neighbour's cell lose its centre", n_healed);
}

/// The last inclusion, from 1, with a region around the point or an image of it; 0: none.
template <int dim>
int inclusion_at(const Scene &scene, const Vector<dim> &x)
{
  int k = int(scene.inclusions.size());
  while (k > 0 && !is_in_regions<dim>(scene.specimen, scene.inclusions[k - 1].balls,
                                      scene.inclusions[k - 1].boxes, x))
    --k;
  return k;
}

/// Materials of the points: those of their regions over those that they have.
template <int dim, typename Place>
void assign_materials(const Scene &scene, int n, const Place &place, std::vector<int> &material)
{
  material.resize(n, 0);
  for (int i = 0; i < n; ++i)
    if (const int k = inclusion_at<dim>(scene, place(i)); k > 0)
      material[i] = k;
}

/// Particles of other materials; none of them, nor a neighbour, may lie in an overlap.
template <int dim>
void set_materials(const Scene &scene, std::optional<packings::Seeds<dim>> &seeds,
                   packings::Packing<dim> &packing, core::Log &log)
{
  if (scene.inclusions.empty()) {
    if (std::count(packing.material.begin(), packing.material.end(), 0) !=
        long(packing.material.size()))
      throw core::KeyedError("/discrete_zone/packing_file",
                             scene.zone.packing_file + " names materials other than 0",
                             "the scene has no inclusions", "add them to /inclusions");
    packing.material.clear();
    return;
  }
  const auto centre = [&](int i) { return get(packing.centre, i); };
  assign_materials<dim>(scene, packing.size(), centre, packing.material);
  if (seeds)
    assign_materials<dim>(
        scene, seeds->size(), [&](int i) { return seeds->centre[i]; }, seeds->material);
  const double keep_off = reach_of_overlap(scene);
  const auto zone = zone_shape<dim>(scene);
  std::vector<long> number(scene.inclusions.size() + 1, 0);
  for (int i = 0; i < packing.size(); ++i) {
    const int k = packing.material[i];
    if (k >= int(number.size()))
      throw core::KeyedError(
          "/discrete_zone/packing_file",
          fmt::format("material {} of {} is no inclusion", k, scene.zone.packing_file),
          fmt::format("/inclusions has {}", scene.inclusions.size()),
          "add inclusions, or give the particles another material");
    ++number[k];
    if (k > 0 && keep_off > 0 && zone.distance(centre(i)) < keep_off)
      throw core::InputError(fmt::format(
          "/inclusions/{}: a particle of it lies in the overlap, at x = {:.4g} m, y = {:.4g} m: "
          "the "
          "overlap is of /material alone; widen the discrete zone or move the inclusion",
          k - 1, centre(i)[0], centre(i)[1]));
  }
  for (std::size_t k = 1; k < number.size(); ++k) {
    require(
        number[k] > 0,
        fmt::format("/inclusions/{}: no particle has its centre there; enlarge or move it", k - 1));
    log.info("inclusion {}: {} particles", k, number[k]);
  }
}
} // namespace

template <int dim>
PackedZone<dim> make_packing(const Scene &scene, Reference &reference, core::Log &log)
{
  PackedZone<dim> zone;
  if (scene.atoms) {
    zone.packing = make_crystal_packing<dim>(scene, log);
    return zone;
  }
  if (!scene.zone.is_irregular())
    zone.packing = packings::make_lattice_packing<dim>(lattice_of<dim>(scene));
  else {
    auto seeds = find_seeds<dim>(scene, reference);
    auto irregular =
        scene.zone.packing == PackingKind::random
            ? packings::pack_relaxed_seeds<dim>(random_packing_of<dim>(scene), std::move(seeds))
            : pack_file<dim>(scene, std::move(seeds));
    report_healed(irregular.n_healed, log);
    zone.n_healed = irregular.n_healed;
    zone.seeds = std::move(irregular.seeds);
    zone.packing = std::move(irregular.packing);
  }
  set_materials(scene, zone.seeds, zone.packing, log);
  return zone;
}

namespace
{
// A file is packed whole: what it costs is one cell for each particle.
template <int dim>
PartOfZone<dim> make_irregular_part(const Scene &scene, Reference &reference,
                                    const core::Ranks &ranks, int rings, core::Log &log,
                                    const packings::Groups<dim> &groups,
                                    const std::vector<std::int64_t> &weights)
{
  PartOfZone<dim> zone;
  if (scene.zone.packing == PackingKind::file) {
    auto [whole, seeds, n_healed] = make_packing<dim>(scene, reference, log);
    const auto partition = particles::make_partition(whole.size(), ranks.size(), weights);
    zone.held = packings::part_of(std::move(whole), partition, ranks.rank(), rings, 0, groups);
    zone.seeds = std::move(seeds);
    zone.n_healed = n_healed;
    return zone;
  }
  auto random = packings::make_random_part<dim>(random_packing_of<dim>(scene),
                                                find_seeds<dim>(scene, reference, ranks), ranks,
                                                rings, groups, weights);
  report_healed(random.n_healed, log);
  zone.held = std::move(random.held);
  zone.seeds = std::move(random.seeds);
  zone.n_healed = random.n_healed;
  return zone;
}
} // namespace

template <int dim>
PartOfZone<dim> make_packing_part(const Scene &scene, Reference &reference,
                                  const core::Ranks &ranks, int rings, core::Log &log,
                                  const packings::Groups<dim> &groups,
                                  const std::vector<std::int64_t> &weights)
{
  PartOfZone<dim> zone;
  if (!scene.zone.is_irregular()) {
    zone.held =
        packings::make_lattice_part<dim>(lattice_of<dim>(scene), ranks, rings, groups, weights);
    return zone;
  }
  zone = make_irregular_part(scene, reference, ranks, rings, log, groups, weights);
  if (groups.of)
    zone.overlap = packings::gather_grouped(zone.held, groups, rings, ranks);
  return zone;
}

template packings::SpecimenParameters<2> packed_specimen_of(const Scene &);
template packings::SpecimenParameters<3> packed_specimen_of(const Scene &);
template packings::LatticeParameters<2> lattice_of(const Scene &);
template packings::LatticeParameters<3> lattice_of(const Scene &);
template packings::RandomParameters<2> random_packing_of(const Scene &);
template packings::RandomParameters<3> random_packing_of(const Scene &);
template PackedZone<2> make_packing(const Scene &, Reference &, core::Log &);
template PackedZone<3> make_packing(const Scene &, Reference &, core::Log &);
template PartOfZone<2> make_packing_part(const Scene &, Reference &, const core::Ranks &, int,
                                         core::Log &, const packings::Groups<2> &,
                                         const std::vector<std::int64_t> &);
template PartOfZone<3> make_packing_part(const Scene &, Reference &, const core::Ranks &, int,
                                         core::Log &, const packings::Groups<3> &,
                                         const std::vector<std::int64_t> &);
} // namespace ligament::program
