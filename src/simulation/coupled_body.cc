#include "src/simulation/coupled_body.h"

#include "core/check.h"
#include "core/keyed_error.h"
#include "core/outline.h"
#include "coupling/bridging_domain.h"
#include "coupling/fine_scale_split.h"
#include "coupling/heated_particles.h"
#include "fem/import_mesh.h"
#include "fem/join_sides.h"
#include "fem/part_shares.h"
#include "src/scene/atoms.h"
#include "src/scene/body_file.h"
#include "src/scene/body_shape.h"
#include "src/scene/geometry.h"
#include "src/simulation/heat.h"
#include "src/simulation/make_loads.h"
#include "src/simulation/make_zone.h"
#include "src/simulation/tools/make_tools.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
using core::require;

/// Volume of the specimen without its holes and notches, in m^3.
double material_volume(const Scene &scene)
{
  const Specimen &specimen = scene.specimen;
  double volume = 1;
  const double side = scene.zone.spacing / 2;
  if (const auto flat = scene.dimension == 2 ? solid_of<2>(specimen, side) : nullptr)
    return flat->volume() * specimen.thickness;
  if (const auto solid = scene.dimension == 3 ? solid_of<3>(specimen, side) : nullptr)
    volume = solid->volume();
  else
    for (int c = 0; c < scene.dimension; ++c)
      volume *= specimen.size[c];
  for (const auto &hole : scene.specimen.holes)
    volume -= M_PI * hole.radius * hole.radius;
  for (const auto &notch : scene.specimen.notches) {
    double box = 1;
    for (int c = 0; c < scene.dimension; ++c)
      box *= std::max(0., std::min(notch.upper[c], specimen.upper(c)) -
                              std::max(notch.lower[c], specimen.lower(c)));
    volume -= box;
  }
  return volume * (scene.dimension == 2 ? scene.specimen.thickness : 1);
}

/// Those of the body's file, or made to its outline.
template <int dim>
fem::Mesh<dim> make_cells(const Scene &scene, const fem::MeshParameters<dim> &p)
{
  if constexpr (dim == 2)
    if (scene.far_field->cells_from_file) {
      const GmshMesh &file = scene.specimen.body->mesh;
      std::vector<Vector<2>> places;
      for (const auto &x : file.nodes)
        places.push_back(x.template head<2>());
      std::vector<std::array<int, 4>> quads;
      for (const auto &face : file.faces) {
        const Vector<2> &x = places[face.corners[0]];
        require(face.corners.size() == 4,
                fmt::format("/far_field/cells_from_file: the face at ({:.6g}, {:.6g}) m is a "
                            "triangle; mesh the body by quadrilaterals, or leave the key out: the "
                            "cells then follow the outline",
                            x[0], x[1]));
        quads.push_back({face.corners[0], face.corners[1], face.corners[2], face.corners[3]});
      }
      double of_file = 0;
      for (const auto &polygon : scene.specimen.body->polygons)
        of_file += core::signed_area(polygon);
      require(std::abs(p.outline->volume() - of_file) <= 1e-9 * std::abs(of_file),
              "/far_field/cells_from_file: \"holes\", \"cutouts\" and \"slots\" of the scene "
              "would be filled by the file's cells; leave the openings to the file");
      return fem::import_mesh(places, quads, *p.outline, p.inner);
    }
  return fem::make_mesh(p);
}

/// Joined along the axes along which the body repeats itself.
template <int dim>
fem::Mesh<dim> joined(const Scene &scene, const fem::MeshParameters<dim> &p, fem::Mesh<dim> mesh)
{
  for (int c = 0; c < dim; ++c)
    if (scene.specimen.is_periodic(c))
      fem::join_sides(mesh, c, p.lower, p.upper);
  return mesh;
}

template <int dim>
void make_far(const Scene &scene, Reference &reference, CoupledBody<dim> &body, core::Log &log)
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
  const bool is_coupled = scene.zone.extent == DiscreteZone::Extent::box;
  if (is_coupled) {
    p.inner = zone_shape<dim>(scene).eroded(overlap).boxes;
    require(!p.inner.empty(), "the discrete zone is nowhere wider than its two overlaps; widen it "
                              "or lower /coupling/overlap_cells");
  }
  p.outline_cell_size = scene.far_field->outline_cell_size;
  const double along = p.outline_cell_size > 0 ? p.outline_cell_size : p.cell_size;
  p.outline = mesh_outline_of<dim>(scene.specimen, along / 20, core::BoxUnion<dim>{p.inner});
  const auto constants = elastic_constants_of<dim>(scene);
  fem::Body<dim> material;
  material.stiffness =
      scene.is_warm() ? thermal_stiffness<dim>(scene, reference, log) : constants.stiffness;
  const bool is_split = is_coupled && scene.coupling.scheme == coupling::Scheme::fine_scale_split;
  material.density = (is_split ? scene.coupling.coarse_mass : 1) * constants.density;
  material.thickness = body.thickness;
  body.far = std::make_unique<fem::FemSolver<dim>>(joined(scene, p, make_cells(scene, p)), material,
                                                   body.loads);
  body.dt_far = body.far->stable_step();
  log.info("{} cells, {} nodes, {} hanging, stable step {:.4g} s", body.far->mesh().n_cells(),
           body.far->mesh().n_nodes(), body.far->mesh().hanging.size(), body.dt_far);
}

// Of the stable step with tools, which is a bound and no estimate.
constexpr double largest_share = 0.98;

/// To 12 bits of mantissa: whoever estimates the stable step again, in another order of sums, comes
/// to the same step.
double rounded_down(double step)
{
  int exponent = 0;
  const double mantissa = std::frexp(step, &exponent);
  return std::ldexp(std::floor(std::ldexp(mantissa, 12)), exponent - 12);
}

template <int dim>
void choose_step(const Scene &scene, double contact_rate, CoupledBody<dim> &body)
{
  const double plain = body.zone ? body.dt_zone : body.dt_far;
  // What tools press on answers faster, by no more than this (theory.md eq. (T3)).
  const double stable =
      contact_rate > 0 ? 2 / std::sqrt(std::pow(2 / plain, 2) + contact_rate) : plain;
  double proposal = scene.time.step_fraction * plain;
  if (contact_rate > 0)
    proposal = std::min(proposal, largest_share * stable);
  body.dt = scene.time.step.value_or(rounded_down(proposal));
  require(
      body.dt <= 0.99 * stable,
      fmt::format("/time/{}: {:.4g} s is more than 0.99 of the stable step of {:.4g} s; give at "
                  "most 0.95 of that, or leave it out",
                  scene.time.step ? "step" : "step_fraction", body.dt, stable));
  if (!body.zone || !body.far)
    return;
  const double most = 0.6 * body.dt_far;
  const std::string remedy = scene.time.step
                                 ? fmt::format("{:.4g} s", most)
                                 : fmt::format("{:.2f}", std::floor(100 * most / stable) / 100);
  require(body.dt <= most,
          fmt::format("/time/{}: the step of {:.4g} s is more than 0.6 of the far field's stable "
                      "step of {:.4g} s; give at most {}, or a larger /far_field/cell_size",
                      scene.time.step ? "step" : "step_fraction", body.dt, body.dt_far, remedy));
  require(scene.coupling.step_ratio * body.dt <= most,
          fmt::format("/coupling/step_ratio: {} steps of {:.4g} s are more than 0.6 of the far "
                      "field's stable step of {:.4g} s; give at most {}",
                      scene.coupling.step_ratio, body.dt, body.dt_far, int(most / body.dt)));
}

template <int dim>
coupling::OverlapParameters<dim> overlap_of(const Scene &scene)
{
  coupling::OverlapParameters<dim> overlap;
  overlap.zone = zone_shape<dim>(scene);
  overlap.length = scene.coupling.overlap_cells * scene.far_field->cell_size;
  overlap.spacing = scene.zone.spacing;
  overlap.transition_cells = scene.coupling.transition_cells;
  for (int c = 0; c < dim; ++c)
    if (scene.specimen.is_periodic(c))
      overlap.period[c] = scene.specimen.size[c];
  return overlap;
}

/// Weighs the zone, which changes its stable step.
template <int dim>
void make_bridging_domain(const Scene &scene, Reference &reference, CoupledBody<dim> &body,
                          core::Log &log, core::Timers &timers)
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
  body.dt_zone = reference.value("weighted_stable_step", [&] {
    return std::min(body.force()->stable_step(body.zone->state), coupler->near_stable_step());
  });
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
  p.may_become_nonlinear =
      scene.coupling.regime == RegimeChoice::automatic && body.force()->can_break();
  fem::Body<dim> still = body.far->body(); // as atoms would be without heat
  if (scene.is_warm()) {
    p.thermal_energy = thermal_energy_of(scene);
    p.seed = scene.atoms->seed;
    p.zone_friction = scene.atoms->zone_friction;
    const auto constants = body.force()->elastic_constants();
    still.stiffness = constants.stiffness;
    still.stress = constants.stress;
  }
  auto bodies = body.bodies();
  auto split = std::make_unique<coupling::FineScaleSplit<dim>>(
      bodies, overlap_of<dim>(scene), p, body.dt, timers, scene.is_warm() ? &still : nullptr,
      body.whole_overlap.get());
  const auto &report = split->report();
  log.info(
      "overlap: {} particles ({} pad), {} nodes; patch residual {:.1e} before and {:.1e} after "
      "the fit, which moves {:.1e} of C11",
      report.overlap_particles, report.pad_particles, report.near_nodes,
      report.patch_residual_before, report.patch_residual, report.patch_modulus);
  // Where the fit is asked for what bodies and sides like these don't need.
  constexpr double most = 0.04;
  if (report.patch_modulus > most)
    log.warning(
        "the patch fit moves {:.2g} of C11 in the overlap, where 0.02 is usual: the overlap "
        "may not be stable; let the zone end elsewhere, or give other cells "
        "(/far_field/cell_size)",
        report.patch_modulus);
  body.figures["patch_residual"] = {report.patch_residual, ""};
  body.figures["patch_modulus"] = {report.patch_modulus, ""};
  body.coupler = std::move(split);
}

template <int dim>
void make_heated_particles(const Scene &scene, CoupledBody<dim> &body, core::Timers &timers)
{
  using Heated = coupling::HeatedParticles<dim>;
  const typename Heated::Parameters p = {thermal_energy_of(scene), scene.atoms->zone_friction,
                                         scene.atoms->seed};
  body.coupler = std::make_unique<Heated>(body.bodies(), p, timers);
}

/// What of a side moves as if it were held, in m^2, where a load holds the nodes of its part.
/// Beyond the last node the side follows over a cell: a row of n nodes at a distance h presses a
/// body as a rigid stamp of (n - 1/2) h does, so that of a face with one of two nodes a quarter
/// counts. Where other loads hold the rest there is no such end, and each has its share.
template <int dim>
double held_area(const CoupledBody<dim> &body, int l)
{
  const auto &load = body.loads[l];
  const auto &mesh = body.far->mesh();
  int component = 0;
  while (!load.value[component])
    ++component;
  double area = 0;
  for (const auto &face : mesh.boundary_faces) {
    if (face.boundary != load.boundary)
      continue;
    const auto nodes = fem::face_nodes<dim>(face.face);
    int n_own = 0, n_held = 0;
    for (const int a : nodes) {
      const int node = mesh.cells[face.cell][a];
      const bool is_own =
          load.part.holds(mesh.nodes[node], 1e-9 * mesh.cell_size[face.cell].minCoeff());
      n_own += is_own;
      n_held += is_own || body.far->is_held(node, component);
    }
    const double share = double(n_own) / nodes.size();
    if (n_own > 0)
      area += (n_held == int(nodes.size()) ? share : share * share) *
              fem::part_shares<dim>({}, mesh, face).sum();
  }
  return area * body.thickness;
}

/// Warns where the nodes that a load holds are not nearly its part of the side. Rollers, pins and
/// knife edges are parts whose width is not meant: those below a twentieth of the side.
template <int dim>
void doubt_held_part(const CoupledBody<dim> &body, int l, int n_nodes, core::Log &log)
{
  const LoadPlace<dim> &place = body.load_places[l];
  const double held = held_area(body, l), depth = dim == 2 ? body.thickness : 1;
  const char *unit = dim == 2 ? "m" : "m^2";
  const std::string finding = fmt::format(
      "/loads/{}: the nodes of the far field that it holds ({}) move the side as a part "
      "of {:.4g} {} would, and its part has {:.4g} {}",
      l, n_nodes, held / depth, unit, place.area / depth, unit);
  const bool fits = std::abs(held / place.area - 1) <= 0.1;
  if (fits || place.area < 0.05 * place.side_area)
    log.info("{}", finding);
  else
    log.warning("{}: the mesh knows the ends of a part to a cell; give smaller cells there, or let "
                "the part end a quarter of a cell beyond a node",
                finding);
}

/// Each load must find faces or nodes in its part of a side, and a force all of its area.
template <int dim>
void check_loaded_parts(const Scene &scene, const CoupledBody<dim> &body, core::Log &log)
{
  for (std::size_t l = 0; l < scene.loads.size(); ++l) {
    const auto &load = body.loads[l];
    const bool is_force = scene.loads[l].kind == LoadKind::force;
    const bool is_held = load.kind != core::BoundaryLoad<dim>::Kind::traction;
    const bool has_name = load.boundary > inner_surface<dim>;
    if (load.part.is_whole() && !is_force && (is_held || !has_name) && !(scene.atoms && has_name))
      continue; // crystals have faces on the sides of the box alone
    const std::string key = fmt::format("/loads/{}", l);
    double area = body.zone ? body.loaded_faces[l] : 0;
    const double whole = body.load_places[l].area;
    if (is_held) {
      const int n_nodes = body.far ? body.far->n_held_nodes(int(l)) : 0;
      if (area == 0 && n_nodes == 0)
        throw core::KeyedError(
            key, "no node of the far field lies in the part of the side that this load moves",
            fmt::format("its nodes are about {:.4g} m apart, the part is {:.4g} m^{} large",
                        body.far ? scene.far_field->cell_size : body.spacing,
                        dim == 2 ? whole / body.thickness : whole, dim - 1),
            "make the part wider than a cell, or the cells smaller");
      log.info("load {} holds {} nodes of the far field and faces of {:.4g} m^2 in all; its part "
               "of the side has {:.4g} m^2",
               l, n_nodes, area, whole);
      if (area == 0)
        doubt_held_part(body, int(l), n_nodes, log);
      continue;
    }
    if (body.far)
      area += body.far->loaded_area(int(l));
    // The straight sides that stand for an arc are longer than it by up to (pi/n)^2/6.
    const double slack = has_name ? 0.02 : 1e-6;
    if (!is_force && load.part.is_whole() && area > 0 && std::abs(area / whole - 1) > slack)
      log.warning(
          "load {} acts on {:.4g} m^2 where its side has {:.4g} m^2: cells reach beyond its "
          "ends; give smaller ones along it (/far_field/outline_cell_size)",
          l, area, whole);
    // Where atoms bear of a force it is met all the same, see loads_of_zone().
    const bool is_fitted = scene.atoms && body.zone && body.loaded_faces[l] > 0;
    if (scene.atoms && area == 0)
      throw core::KeyedError(
          key, "the load does not find its part of the side",
          fmt::format("atoms share the area of a side, and those of this part have {:.4g} m^2 of "
                      "its {:.4g} m^2",
                      area, whole),
          fmt::format("make it wider than {:.4g} m, or move it off holes and notches",
                      2 * body.spacing));
    if (area == 0 || (is_force && !is_fitted && std::abs(area / whole - 1) > slack))
      throw core::KeyedError(
          key, "the load does not find its part of the side",
          fmt::format("a hole or notch cuts it: {:.4g} m^2 of {:.4g} m^2 are left", area, whole),
          is_force ? "move the force, or give a traction" : "move the load");
    log.info("load {} acts on {:.6g} m^2", l, area);
  }
}

template <int dim>
std::vector<SkippedPart> skipped_parts(const Scene &scene, const CoupledBody<dim> &body)
{
  std::vector<SkippedPart> skipped;
  if (scene.atoms && !scene.is_warm() && body.coupler->overlap())
    skipped.push_back({"heat bath of the overlap", "/atoms/temperature is 0"});
  if (!body.far)
    skipped.push_back({"far field and overlap", "the whole specimen is discrete"});
  if (!body.zone)
    skipped.push_back({"particles and overlap", "the whole specimen is mesh"});
  const auto add = [&](const std::vector<SkippedPart> &parts) {
    skipped.insert(skipped.end(), parts.begin(), parts.end());
  };
  if (body.zone)
    add(body.force()->skipped_parts());
  add(body.coupler->skipped_parts());
  return skipped;
}
} // namespace

template <int dim>
CoupledBody<dim> make_body(const Scene &scene, core::Log &log, core::Timers &timers,
                           Reference &reference, const ForceMaker<dim> &make_force,
                           const core::Ranks &ranks, const std::vector<std::int64_t> &weights)
{
  CoupledBody<dim> body;
  body.ranks = ranks;
  body.lower = to_vector<dim>(scene.specimen.lower());
  body.upper = to_vector<dim>(scene.specimen.upper());
  body.thickness = dim == 2 ? scene.specimen.thickness : 1;
  body.plane = scene.plane;
  body.poissons_ratio = scene.material.poissons_ratio;
  body.spacing = scene.zone.spacing;
  body.loads = make_loads<dim>(scene);
  body.load_places = load_places(scene, body.loads);
  const SurfaceFaces<dim> sides(scene.specimen);
  for (int boundary = 0; boundary < 2 * dim; ++boundary)
    for (const auto &face : sides.of(boundary))
      body.side_areas[boundary] += body.thickness * core::face_area<dim>(face);
  if (scene.zone.spacing > 0 && scene.zone.packing)
    body.equivalent_particles = std::llround(material_volume(scene) / mean_cell_volume(scene));
  ContactSurface<dim> surface; // that tools may touch
  if (scene.zone.extent != DiscreteZone::Extent::all)
    core::at_key("/far_field", "change cell_size, levels or the zone",
                 [&] { make_far(scene, reference, body, log); });
  if (scene.zone.extent != DiscreteZone::Extent::none)
    core::at_key("/discrete_zone", "change spacing, packing or the shape of specimen and zone",
                 [&] { make_zone(scene, make_force, reference, weights, body, surface, log); });
  using coupling::Scheme;
  const bool coupled = body.zone && body.far && scene.coupling.scheme != Scheme::none;
  if (!coupled) {
    if (scene.is_warm())
      make_heated_particles(scene, body, timers);
    else
      body.coupler = std::make_unique<coupling::NullCoupler<dim>>(timers);
    if (body.far && !scene.tools.empty())
      add_cells(scene, body, surface);
  }
  core::at_key("/coupling", "change overlap_cells, cell_size or the zone", [&] {
    if (coupled && coupling::is_energy_weighted(scene.coupling.scheme))
      make_bridging_domain(scene, reference, body, log, timers);
    choose_step(scene, surface.largest_rate(), body);
    if (!body.coupler)
      make_fine_scale_split(scene, body, log, timers);
  });
  check_loaded_parts(scene, body, log);
  if (body.zone)
    body.zone->body_force = particles::BodyForce<dim>(body.loads);
  if (const auto *overlap = body.coupler->overlap(); overlap && scene.body_force.is_any()) {
    const auto &members = body.whole_overlap ? body.whole_overlap->state : body.zone->state;
    body.far->set_weights(overlap->near_nodes, body.coupler->near_weight(members));
  }
  if (!scene.tools.empty()) {
    if (coupled)
      add_cells(scene, body, surface);
    body.tools = make_tools(scene, body, std::move(surface), log);
  }
  body.skipped = skipped_parts(scene, body);
  return body;
}

template CoupledBody<2> make_body<2>(const Scene &, core::Log &, core::Timers &, Reference &,
                                     const ForceMaker<2> &, const core::Ranks &,
                                     const std::vector<std::int64_t> &);
template CoupledBody<3> make_body<3>(const Scene &, core::Log &, core::Timers &, Reference &,
                                     const ForceMaker<3> &, const core::Ranks &,
                                     const std::vector<std::int64_t> &);
} // namespace ligament::program
