#include "src/simulation/make_zone.h"

#include "core/check.h"
#include "core/keyed_error.h"
#include "dem/principal_tension.h"
#include "dem/toughness_calibration.h"
#include "packings/absorbing_sides.h"
#include "packings/lattice_packing.h"
#include "packings/packing_file.h"
#include "src/scene/geometry.h"
#include "src/simulation/toughness_cache.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ligament::program
{
namespace
{
using core::require;

template <int dim>
void set_specimen(const Scene &scene, packings::SpecimenParameters<dim> &p)
{
  p.spacing = scene.zone.spacing;
  p.thickness = scene.specimen.thickness;
  p.upper = to_vector<dim>(scene.specimen.size) / 2;
  p.lower = -p.upper;
  for (const auto &hole : scene.specimen.holes)
    p.holes.push_back({to_vector<dim>(hole.centre), hole.radius});
  for (const auto &notch : scene.specimen.notches)
    p.notches.push_back({to_vector<dim>(notch.lower), to_vector<dim>(notch.upper)});
  for (const auto &crack : scene.specimen.cracks) {
    auto &points = p.cracks.emplace_back();
    for (const auto &point : crack.points)
      points.push_back(to_vector<dim>(point));
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

template <int dim>
packings::LatticeParameters<dim> lattice_of(const Scene &scene)
{
  packings::LatticeParameters<dim> p;
  set_specimen<dim>(scene, p);
  p.kind = packings::lattice_kind(scene.zone.packing);
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

dem::DemMaterial material_of(const MaterialParameters &parameters, PlaneMode plane)
{
  dem::DemMaterial m;
  m.youngs_modulus = parameters.youngs_modulus;
  m.poissons_ratio = parameters.poissons_ratio;
  m.density = parameters.density;
  m.plane = plane;
  m.friction = parameters.friction;
  return m;
}

dem::FractureLaw::Criterion criterion_of(const Scene &scene)
{
  using Criterion = dem::FractureLaw::Criterion;
  const std::string &name = scene.material.fracture.criterion;
  return name == "maximum_tension" ? Criterion::maximum_tension
         : name == "face_tension"  ? Criterion::face_tension
                                   : Criterion::none;
}

/// All that the factor c depends on, in one line.
std::string toughness_key(const Scene &scene, const dem::DemMaterial &material)
{
  const DiscreteZone &zone = scene.zone;
  const std::string packing =
      zone.packing == "random"
          ? fmt::format("sweeps {} ratio {}", zone.relaxation_sweeps, zone.size_ratio)
          : fmt::format("turned {}", fmt::join(zone.orientation, " "));
  return fmt::format("c{} {} {}D {} {} nu {} {}", dem::toughness_method,
                     scene.material.fracture.criterion, scene.dimension,
                     scene.plane == PlaneMode::stress ? "stress" : "strain", zone.packing,
                     material.poissons_ratio, packing);
}

template <int dim>
double toughness_factor(const Scene &scene, const dem::DemMaterial &material)
{
  const auto criterion = criterion_of(scene);
  return ToughnessCache().factor(toughness_key(scene, material), [&] {
    if (scene.zone.packing == "random")
      return dem::calibrate_toughness<dim>(random_packing_of<dim>(scene), material, criterion);
    const auto lattice = lattice_of<dim>(scene);
    return dem::calibrate_toughness<dim>(lattice.kind, lattice.orientation, material, criterion);
  });
}

/// Strength from the scene, or from the toughness through the calibrated factor c. `name` is added
/// to the names of the figures.
template <int dim>
double strength_of(const Scene &scene, const MaterialParameters &material, const std::string &name,
                   CoupledBody<dim> &body, core::Log &log)
{
  const auto &p = material.fracture;
  double strength = p.strength.value_or(0);
  if (!p.strength) {
    const double c = toughness_factor<dim>(scene, material_of(material, scene.plane));
    strength = c * *p.toughness / std::sqrt(scene.zone.spacing);
    body.figures["toughness_factor" + name] = {c, ""};
    log.info("toughness factor c = {:.4f}: strength {:.4g} Pa at spacing {:.4g} m", c, strength,
             scene.zone.spacing);
  }
  body.figures["strength" + name] = {strength, "Pa"};
  return strength;
}

template <int dim>
dem::FractureLaw fracture_of(const Scene &scene, CoupledBody<dim> &body, core::Log &log)
{
  dem::FractureLaw law;
  law.criterion = criterion_of(scene);
  if (law.criterion == dem::FractureLaw::Criterion::none)
    return law;
  if (!scene.material.fracture.strength)
    law.whole_face = dem::PrincipalTension<dim>::whole_face(scene.zone.spacing) *
                     (dim == 2 ? scene.specimen.thickness : 1);
  law.strength = strength_of<dim>(scene, scene.material, "", body, log);
  if (scene.inclusions.empty())
    return law;
  law.strengths = {law.strength};
  for (std::size_t k = 0; k < scene.inclusions.size(); ++k)
    law.strengths.push_back(strength_of<dim>(scene, scene.inclusions[k].material,
                                             fmt::format("_inclusion_{}", k + 1), body, log));
  return law;
}

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
  for (int c = 0; c < dim; ++c) {
    const double low = std::max(p.lower[c], p.zone_lower[c]),
                 high = std::min(p.upper[c], p.zone_upper[c]);
    if (std::max(lower[c] - low, high - upper[c]) > 3 * p.spacing)
      throw core::KeyedError(
          "/discrete_zone/packing_file",
          fmt::format("the particles of {} do not fill the discrete zone in {}",
                      scene.zone.packing_file, "xyz"[c]),
          fmt::format("they go from {:.4g} m to {:.4g} m, the zone from {:.4g} m to {:.4g} m",
                      lower[c], upper[c], low, high),
          "give a file for this zone: that of a run with far field holds its zone alone, its pure "
          "discrete twin needs the packing of the whole specimen");
  }
}

/// Seeds of an irregular packing, from their file or from random numbers.
template <int dim>
packings::RandomPacking<dim> irregular_packing(const Scene &scene)
{
  const auto parameters = random_packing_of<dim>(scene);
  if (scene.zone.packing == "random")
    return packings::make_random_packing<dim>(parameters);
  auto seeds = read_seeds<dim>(scene);
  const std::vector<int> material = std::move(seeds.material);
  seeds.material.clear();
  require_cover(scene, parameters, seeds);
  auto packing = packings::pack_seeds<dim>(parameters, std::move(seeds));
  for (const auto row : packing.packing.global_id) // the name of a seed is the number of its row
    if (!material.empty())
      packing.packing.material.push_back(material[row]);
  for (const auto row : packing.seeds.id)
    if (!material.empty())
      packing.seeds.material.push_back(material[row]);
  const auto &cells = packing.packing.volume;
  const double mean = std::accumulate(cells.begin(), cells.end(), 0.) / double(cells.size());
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

/// The last inclusion, from 1, with a region around the point; 0: none.
template <int dim>
int inclusion_at(const Scene &scene, const Vector<dim> &x)
{
  const auto in_ball = [&](const Hole &ball) {
    return (x - to_vector<dim>(ball.centre)).norm() < ball.radius;
  };
  const auto in_box = [&](const Notch &box) {
    return (x.array() > to_vector<dim>(box.lower).array()).all() &&
           (x.array() < to_vector<dim>(box.upper).array()).all();
  };
  for (int k = int(scene.inclusions.size()); k > 0; --k) {
    const Inclusion &inclusion = scene.inclusions[k - 1];
    if (std::any_of(inclusion.balls.begin(), inclusion.balls.end(), in_ball) ||
        std::any_of(inclusion.boxes.begin(), inclusion.boxes.end(), in_box))
      return k;
  }
  return 0;
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
void set_materials(const Scene &scene, CoupledBody<dim> &body, packings::Packing<dim> &packing,
                   core::Log &log)
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
  if (body.seeds)
    assign_materials<dim>(
        scene, body.seeds->size(), [&](int i) { return body.seeds->centre[i]; },
        body.seeds->material);
  const bool coupled = scene.far_field && scene.zone.extent == DiscreteZone::Extent::box;
  const double keep_off =
      coupled ? scene.coupling.overlap_cells * scene.far_field->cell_size + 2 * scene.zone.spacing
              : 0;
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
    if (k > 0 && coupled && zone.distance(centre(i)) < keep_off)
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

template <int dim>
packings::Packing<dim> make_packing(const Scene &scene, CoupledBody<dim> &body, core::Log &log)
{
  if (!scene.zone.is_irregular())
    return packings::make_lattice_packing<dim>(lattice_of<dim>(scene));
  auto irregular = irregular_packing<dim>(scene);
  if (irregular.n_healed > 0)
    log.info("{} radii made smaller, lest a neighbour's cell lose its centre", irregular.n_healed);
  body.figures["healed_radii"] = {double(irregular.n_healed), ""};
  body.seeds = std::move(irregular.seeds);
  return std::move(irregular.packing);
}

template <int dim>
BrokenBond cut_face(const packings::Packing<dim> &packing, const packings::Face<dim> &face,
                    double thickness)
{
  BrokenBond cut = {};
  cut.i = packing.global_id[face.i];
  cut.j = packing.global_id[face.j];
  const Vector<dim> place = get(packing.centre, face.i) + face.lever_i;
  for (int c = 0; c < dim; ++c) {
    cut.centroid[c] = place[c];
    cut.normal[c] = face.normal[c];
  }
  cut.size = face.area / thickness;
  return cut;
}
} // namespace

dem::DemMaterial material_of(const Scene &scene)
{
  return material_of(scene.material, scene.plane);
}

double mean_cell_volume(const Scene &scene)
{
  const double d = scene.zone.spacing, thickness = scene.specimen.thickness;
  if (scene.zone.is_irregular())
    return scene.dimension == 2 ? packings::mean_cell_volume<2>(d) * thickness
                                : packings::mean_cell_volume<3>(d);
  switch (packings::lattice_kind(scene.zone.packing)) {
  case packings::LatticeKind::square:
    return d * d * thickness;
  case packings::LatticeKind::hexagonal:
    return std::sqrt(3.) / 2 * d * d * thickness;
  case packings::LatticeKind::simple_cubic:
    return d * d * d;
  case packings::LatticeKind::fcc:
    return d * d * d / std::sqrt(2.);
  }
  return 0;
}

template <int dim>
void make_zone(const Scene &scene, CoupledBody<dim> &body, core::Log &log)
{
  const auto fracture = fracture_of<dim>(scene, body, log);
  auto packing = make_packing<dim>(scene, body, log);
  set_materials(scene, body, packing, log);
  std::vector<dem::DemMaterial> materials = {material_of(scene)};
  std::vector<double> densities = {scene.material.density};
  for (const Inclusion &inclusion : scene.inclusions) {
    materials.push_back(material_of(inclusion.material, scene.plane));
    densities.push_back(inclusion.material.density);
  }
  particles::Particles<dim> state;
  packings::fill_particles(packing, densities, state);
  const auto constants = material_of(scene).elastic_constants<dim>();
  auto dashpots = packings::absorbing_dashpots(packing, state, body.loads, scene.material.density,
                                               constants.wave_speed_p, constants.wave_speed_s);
  for (const auto &face : packing.faces)
    if (face.cracked)
      body.cut_faces.push_back(cut_face<dim>(packing, face, body.thickness));
  body.n_cracked_faces = std::int64_t(body.cut_faces.size());
  const dem::Materials of_particles(std::move(materials), packing.material);
  auto force = std::make_unique<dem::ManyBodyForce<dim>>(std::move(packing), of_particles,
                                                         body.loads, fracture);
  body.force = force.get();
  body.zone = std::make_unique<particles::ParticleSolver<dim>>(std::move(state), std::move(force));
  body.zone->dashpots = std::move(dashpots);
  body.dt_zone = body.force->stable_step(body.zone->state);
  log.info("{} particles, {} bonds, {} faces cut by cracks, stable step {:.4g} s",
           body.zone->state.n_owned, body.force->n_bonds(), body.n_cracked_faces, body.dt_zone);
}

template void make_zone<2>(const Scene &, CoupledBody<2> &, core::Log &);
template void make_zone<3>(const Scene &, CoupledBody<3> &, core::Log &);
} // namespace ligament::program
