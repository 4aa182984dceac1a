#include "src/simulation/coupled_body.h"

#include "core/check.h"
#include "dem/toughness_calibration.h"
#include "particles/absorbing_sides.h"
#include "particles/lattice_packing.h"
#include "particles/packing_file.h"
#include "src/scene/geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ligament::program
{
namespace
{
using core::require;

template <int dim>
std::vector<core::BoundaryLoad<dim>> make_loads(const Scene &scene)
{
  const std::array<const char *, 6> names = {"left", "right", "bottom", "top", "back", "front"};
  std::vector<core::BoundaryLoad<dim>> loads;
  for (const auto &parameters : scene.loads) {
    core::BoundaryLoad<dim> load;
    using Kind = typename core::BoundaryLoad<dim>::Kind;
    load.boundary = int(std::find(names.begin(), names.end(), parameters.boundary) - names.begin());
    load.kind = parameters.kind == "velocity"       ? Kind::velocity
                : parameters.kind == "displacement" ? Kind::displacement
                                                    : Kind::traction;
    for (int c = 0; c < dim; ++c)
      load.value[c] = parameters.value[c];
    load.ramp.duration = parameters.ramp;
    load.absorbing = parameters.absorbing;
    load.absorbing_layer = parameters.absorbing_layer;
    loads.push_back(load);
  }
  return loads;
}

template <int dim>
void set_specimen(const Scene &scene, particles::SpecimenParameters<dim> &p)
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
}

template <int dim>
particles::LatticeParameters<dim> lattice_of(const Scene &scene)
{
  particles::LatticeParameters<dim> p;
  set_specimen<dim>(scene, p);
  if (scene.zone.extent == DiscreteZone::Extent::box && scene.zone.boxes.size() > 1)
    p.zone_parts = zone_shape<dim>(scene);
  p.kind = particles::lattice_kind(scene.zone.packing);
  for (int c = 0; c < n_spins<dim>; ++c)
    p.orientation[c] = scene.zone.orientation[c];
  return p;
}

template <int dim>
particles::RandomParameters<dim> random_packing_of(const Scene &scene)
{
  particles::RandomParameters<dim> p;
  set_specimen<dim>(scene, p);
  p.seed = scene.zone.seed;
  p.relaxation_sweeps = scene.zone.relaxation_sweeps;
  p.size_ratio = scene.zone.size_ratio;
  return p;
}

dem::DemMaterial material_of(const Scene &scene)
{
  dem::DemMaterial m;
  m.youngs_modulus = scene.material.youngs_modulus;
  m.poissons_ratio = scene.material.poissons_ratio;
  m.density = scene.material.density;
  m.plane = scene.plane;
  m.friction = scene.material.friction;
  return m;
}

/// Volume of the specimen without its holes and notches, in m^3.
double material_volume(const Scene &scene)
{
  double volume = 1;
  for (int c = 0; c < scene.dimension; ++c)
    volume *= scene.specimen.size[c];
  for (const auto &hole : scene.specimen.holes)
    volume -= M_PI * hole.radius * hole.radius;
  for (const auto &notch : scene.specimen.notches) {
    double box = 1;
    for (int c = 0; c < scene.dimension; ++c)
      box *= std::max(0., std::min(notch.upper[c], scene.specimen.size[c] / 2) -
                              std::max(notch.lower[c], -scene.specimen.size[c] / 2));
    volume -= box;
  }
  return volume * (scene.dimension == 2 ? scene.specimen.thickness : 1);
}

double mean_cell_volume(const Scene &scene)
{
  const double d = scene.zone.spacing, thickness = scene.specimen.thickness;
  if (scene.zone.is_irregular())
    return scene.dimension == 2 ? particles::mean_cell_volume<2>(d) * thickness
                                : particles::mean_cell_volume<3>(d);
  switch (particles::lattice_kind(scene.zone.packing)) {
  case particles::LatticeKind::square:
    return d * d * thickness;
  case particles::LatticeKind::hexagonal:
    return std::sqrt(3.) / 2 * d * d * thickness;
  case particles::LatticeKind::simple_cubic:
    return d * d * d;
  case particles::LatticeKind::fcc:
    return d * d * d / std::sqrt(2.);
  }
  return 0;
}

template <int dim>
double toughness_factor(const Scene &scene)
{
  if (scene.zone.packing == "random")
    return dem::calibrate_toughness<dim>(random_packing_of<dim>(scene), material_of(scene));
  const auto lattice = lattice_of<dim>(scene);
  return dem::calibrate_toughness<dim>(lattice.kind, lattice.orientation, material_of(scene));
}

/// Strength from the scene, or from the toughness through the calibrated factor c.
template <int dim>
dem::FractureLaw fracture_of(const Scene &scene, CoupledBody<dim> &body, core::Log &log)
{
  dem::FractureLaw law;
  const auto &p = scene.material.fracture;
  if (p.criterion == "none")
    return law;
  law.criterion = dem::FractureLaw::Criterion::maximum_tension;
  if (p.strength)
    law.strength = *p.strength;
  else {
    const double c = toughness_factor<dim>(scene);
    law.strength = c * *p.toughness / std::sqrt(scene.zone.spacing);
    body.figures["toughness_factor"] = {c, ""};
    log.info("toughness factor c = {:.4f}: strength {:.4g} Pa at spacing {:.4g} m", c, law.strength,
             scene.zone.spacing);
  }
  body.figures["strength"] = {law.strength, "Pa"};
  return law;
}

/// Seeds of an irregular packing, from their file or from random numbers.
template <int dim>
particles::RandomPacking<dim> irregular_packing(const Scene &scene)
{
  const auto parameters = random_packing_of<dim>(scene);
  if (scene.zone.packing == "random")
    return particles::make_random_packing<dim>(parameters);
  auto packing = particles::pack_seeds<dim>(
      parameters, particles::read_packing_file<dim>(scene.zone.packing_file));
  const auto &cells = packing.packing.volume;
  const double mean = std::accumulate(cells.begin(), cells.end(), 0.) / double(cells.size());
  const double ratio = std::pow(mean / mean_cell_volume(scene), 1. / dim);
  require(
      ratio > 0.9 && ratio < 1.1,
      fmt::format("/discrete_zone/spacing: the packing of {} has the spacing {:.4g} m; give that",
                  scene.zone.packing_file, ratio * scene.zone.spacing));
  return packing;
}

template <int dim>
particles::Packing<dim> make_packing(const Scene &scene, CoupledBody<dim> &body, core::Log &log)
{
  if (!scene.zone.is_irregular())
    return particles::make_lattice_packing<dim>(lattice_of<dim>(scene));
  auto irregular = irregular_packing<dim>(scene);
  if (irregular.n_healed > 0)
    log.info("{} radii made smaller, lest a neighbour's cell lose its centre", irregular.n_healed);
  body.figures["healed_radii"] = {double(irregular.n_healed), ""};
  body.seeds = std::move(irregular.seeds);
  return std::move(irregular.packing);
}

template <int dim>
void make_zone(const Scene &scene, CoupledBody<dim> &body, core::Log &log)
{
  const auto fracture = fracture_of<dim>(scene, body, log);
  auto packing = make_packing<dim>(scene, body, log);
  particles::Particles<dim> state;
  particles::fill_particles(packing, scene.material.density, state);
  const auto constants = material_of(scene).elastic_constants<dim>();
  auto dashpots = particles::absorbing_dashpots(packing, state, body.loads, scene.material.density,
                                                constants.wave_speed_p, constants.wave_speed_s);
  body.n_cracked_faces = std::count_if(packing.faces.begin(), packing.faces.end(),
                                       [](const auto &face) { return face.cracked; });
  auto force = std::make_unique<dem::ManyBodyForce<dim>>(std::move(packing), material_of(scene),
                                                         body.loads, fracture);
  body.force = force.get();
  body.zone = std::make_unique<particles::ParticleSolver<dim>>(std::move(state), std::move(force));
  body.zone->dashpots = std::move(dashpots);
  body.dt_zone = body.force->stable_step(body.zone->state);
  log.info("{} particles, {} bonds, {} faces cut by cracks, stable step {:.4g} s",
           body.zone->state.n_owned, body.force->n_bonds(), body.n_cracked_faces, body.dt_zone);
}

template <int dim>
void make_far(const Scene &scene, CoupledBody<dim> &body, core::Log &log)
{
  fem::MeshParameters<dim> p;
  p.lower = body.lower;
  p.upper = body.upper;
  p.cell_size = scene.far_field->cell_size;
  p.levels = scene.far_field->levels;
  p.cells_per_level = scene.far_field->cells_per_level;
  p.growth = scene.far_field->growth;
  p.fine_cells = fine_cells(scene);
  const double overlap = scene.coupling.overlap_cells * p.cell_size;
  if (scene.zone.extent == DiscreteZone::Extent::box) {
    p.inner = zone_shape<dim>(scene).eroded(overlap).boxes;
    require(!p.inner.empty(), "the discrete zone is nowhere wider than its two overlaps; widen it "
                              "or lower /coupling/overlap_cells");
  }
  const auto constants = material_of(scene).elastic_constants<dim>();
  fem::Body<dim> material;
  material.stiffness = constants.stiffness;
  material.density = scene.coupling.coarse_mass * constants.density;
  material.thickness = body.thickness;
  body.far = std::make_unique<fem::FemSolver<dim>>(fem::make_mesh(p), material, body.loads);
  body.dt_far = body.far->stable_step();
  log.info("{} cells, {} nodes, {} hanging, stable step {:.4g} s", body.far->mesh().n_cells(),
           body.far->mesh().n_nodes(), body.far->mesh().hanging.size(), body.dt_far);
}

template <int dim>
void choose_step(const Scene &scene, CoupledBody<dim> &body)
{
  const double stable = body.zone ? body.dt_zone : body.dt_far;
  body.dt = scene.time.step.value_or(scene.time.step_fraction * stable);
  require(
      body.dt <= 0.99 * stable,
      fmt::format("/time/step: {:.4g} s is above the stable step of {:.4g} s; give at most 0.95 "
                  "of that, or leave it out",
                  body.dt, stable));
  if (body.zone && body.far)
    require(scene.coupling.step_ratio * body.dt <= 0.6 * body.dt_far,
            fmt::format("/coupling/step_ratio: {} steps of {:.4g} s are more than 0.6 of the far "
                        "field's stable step of {:.4g} s; give at most {}",
                        scene.coupling.step_ratio, body.dt, body.dt_far,
                        int(0.6 * body.dt_far / body.dt)));
}

template <int dim>
coupling::OverlapParameters<dim> overlap_of(const Scene &scene)
{
  coupling::OverlapParameters<dim> overlap;
  overlap.zone = zone_shape<dim>(scene);
  overlap.length = scene.coupling.overlap_cells * scene.far_field->cell_size;
  overlap.spacing = scene.zone.spacing;
  overlap.transition_cells = scene.coupling.transition_cells;
  return overlap;
}

/// Weighs the zone, which changes its stable step.
template <int dim>
void make_bridging_domain(const Scene &scene, CoupledBody<dim> &body, core::Log &log,
                          core::Timers &timers)
{
  require(
      scene.coupling.step_ratio == 1,
      "/coupling/step_ratio: energy-weighted schemes join all velocities in every step; give 1");
  coupling::OverlapParameters<dim> overlap = overlap_of<dim>(scene);
  overlap.shape = scene.coupling.weight;
  coupling::BridgingDomainParameters p;
  p.scheme = scene.coupling.scheme;
  p.fine_damper = scene.coupling.fine_damper;
  p.damper_form = scene.coupling.damper_form;
  p.multiplier_cells = scene.coupling.multiplier_cells;
  p.reference_strain = scene.coupling.ghost_force_correction;
  p.solver = scene.coupling.solver;
  auto bodies = body.bodies();
  auto coupler = std::make_unique<coupling::BridgingDomain<dim>>(bodies, overlap, p, timers);
  const double plain = body.dt_zone;
  body.dt_zone = std::min(body.force->stable_step(body.zone->state), coupler->near_stable_step());
  log.info("overlap: {} particles, {} nodes, {} multipliers; stable step {:.4g} s with energy "
           "weights, {:.3f} of the plain one",
           coupler->overlap()->members.size(), coupler->overlap()->n_nodes(),
           coupler->n_multipliers(), body.dt_zone, body.dt_zone / plain);
  body.coupler = std::move(coupler);
}

template <int dim>
void make_fine_scale_split(const Scene &scene, CoupledBody<dim> &body, core::Log &log,
                           core::Timers &timers)
{
  coupling::FineScaleSplitParameters p;
  p.step_ratio = scene.coupling.step_ratio;
  p.fine_damper = scene.coupling.fine_damper;
  p.gap_filter = scene.coupling.gap_filter;
  p.patch_fit = scene.coupling.patch_fit;
  p.solver = scene.coupling.solver;
  p.coarse_mass = scene.coupling.coarse_mass;
  auto bodies = body.bodies();
  auto split = std::make_unique<coupling::FineScaleSplit<dim>>(bodies, overlap_of<dim>(scene), p,
                                                               body.dt, timers);
  const auto &report = split->report();
  log.info(
      "overlap: {} particles ({} pad), {} nodes; patch residual {:.1e} before and {:.1e} after "
      "the fit, which moves {:.1e} of C11",
      report.overlap_particles, report.pad_particles, report.near_nodes,
      report.patch_residual_before, report.patch_residual, report.patch_modulus);
  body.figures["patch_residual"] = {report.patch_residual, ""};
  body.figures["patch_modulus"] = {report.patch_modulus, ""};
  body.split = split.get();
  body.coupler = std::move(split);
}

template <int dim>
std::vector<SkippedPart> skipped_parts(const Scene &scene, const CoupledBody<dim> &body)
{
  std::vector<SkippedPart> skipped;
  if (!body.far)
    skipped.push_back({"far field and overlap", "the whole specimen is discrete"});
  if (!body.zone)
    skipped.push_back({"particles and overlap", "the whole specimen is mesh"});
  if (body.zone && scene.material.poissons_ratio == 0)
    skipped.push_back({"dilatation sweep", "Poisson's ratio is 0"});
  if (body.zone && scene.material.fracture.criterion == "none")
    skipped.push_back({"bond checks", "no fracture criterion"});
  if (body.zone)
    skipped.push_back({"stress tensors in the loop", "the criterion reads tractions; tensors are "
                                                     "computed for output only"});
  if (body.zone && body.n_cracked_faces == 0)
    skipped.push_back({"contacts until a bond breaks", "no initial crack"});
  if (body.split && scene.coupling.gap_filter == 0)
    skipped.push_back({"gap-band filter", "/coupling/gap_filter is 0"});
  if (body.coupler->overlap() && scene.coupling.fine_damper == 0)
    skipped.push_back({"fluctuation damper", "/coupling/fine_damper is 0"});
  return skipped;
}
} // namespace

template <int dim>
CoupledBody<dim> make_body(const Scene &scene, core::Log &log, core::Timers &timers)
{
  CoupledBody<dim> body;
  body.upper = to_vector<dim>(scene.specimen.size) / 2;
  body.lower = -body.upper;
  body.thickness = dim == 2 ? scene.specimen.thickness : 1;
  body.plane = scene.plane;
  body.poissons_ratio = scene.material.poissons_ratio;
  body.spacing = scene.zone.spacing;
  body.loads = make_loads<dim>(scene);
  if (scene.zone.spacing > 0)
    body.equivalent_particles = std::llround(material_volume(scene) / mean_cell_volume(scene));
  if (scene.zone.extent != DiscreteZone::Extent::none)
    make_zone(scene, body, log);
  if (scene.zone.extent != DiscreteZone::Extent::all)
    make_far(scene, body, log);
  using coupling::Scheme;
  const bool coupled = body.zone && body.far && scene.coupling.scheme != Scheme::none;
  if (!coupled)
    body.coupler = std::make_unique<coupling::NullCoupler<dim>>(timers);
  else if (coupling::is_energy_weighted(scene.coupling.scheme))
    make_bridging_domain(scene, body, log, timers);
  choose_step(scene, body);
  if (!body.coupler)
    make_fine_scale_split(scene, body, log, timers);
  body.skipped = skipped_parts(scene, body);
  return body;
}

template CoupledBody<2> make_body<2>(const Scene &, core::Log &, core::Timers &);
template CoupledBody<3> make_body<3>(const Scene &, core::Log &, core::Timers &);
} // namespace ligament::program
