#include "src/simulation/make_zone.h"

#include "core/check.h"
#include "packings/absorbing_sides.h"
#include "packings/outer_face.h"
#include "src/simulation/make_packing.h"
#include "src/simulation/tools/make_tools.h"

#include <fmt/format.h>

#include <cmath>

namespace ligament::program
{
namespace
{
/// Figures that take a calibration begin so.
const std::string calibrated = "toughness_factor";

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

template <int dim>
void require_same_solid(const particles::ElasticConstants<dim> &force,
                        const particles::ElasticConstants<dim> &scene)
{
  const double distance = (force.stiffness - scene.stiffness).norm() / scene.stiffness.norm();
  core::require(distance < 1e-9 && std::abs(force.density / scene.density - 1) < 1e-9,
                fmt::format("/material: the particles' force stands for another solid, of Young's "
                            "modulus {:.6g} Pa and Poisson's ratio {:.6g}",
                            force.youngs_modulus, force.poissons_ratio));
}
} // namespace

template <int dim>
void make_zone(const Scene &scene, const ForceMaker<dim> &make_force, Reference &reference,
               CoupledBody<dim> &body, ContactSurface<dim> &surface, core::Log &log)
{
  auto [packing, seeds, n_healed] = make_packing<dim>(scene, reference, log);
  body.seeds = std::move(seeds);
  if (n_healed)
    body.figures["healed_radii"] = {double(*n_healed), ""};
  particles::Particles<dim> state;
  packings::fill_particles(packing, scene.densities(), state);
  body.loaded_faces.assign(body.loads.size(), 0.);
  for (const auto &face : packing.boundary_faces)
    for (std::size_t l = 0; l < body.loads.size(); ++l)
      if (face.boundary == body.loads[l].boundary)
        if (const auto inside =
                packings::OuterFace<dim>(face, packing).inside({body.loads[l].part}))
          body.loaded_faces[l] += inside->area;
  const auto constants = elastic_constants_of<dim>(scene);
  auto dashpots = packings::absorbing_dashpots(packing, state, body.loads, scene.material.density,
                                               constants.wave_speed_p, constants.wave_speed_s);
  for (const auto &face : packing.faces)
    if (face.cracked)
      body.cut_faces.push_back(cut_face<dim>(packing, face, body.thickness));
  body.n_cracked_faces = std::int64_t(body.cut_faces.size());
  for (const std::string &name : reference.names(calibrated))
    body.figures[name] = {reference.value(name, {}), ""};
  std::optional<packings::Packing<dim>> faces; // the force keeps the packing
  if (!scene.tools.empty())
    faces = packing;
  auto force = make_force(scene, std::move(packing), body.loads, body.figures, log);
  for (const auto &[name, figure] : body.figures)
    if (name.compare(0, calibrated.size(), calibrated) == 0)
      reference.value(name, [&value = figure.value] { return value; });
  require_same_solid(force->elastic_constants(), constants);
  body.zone = std::make_unique<particles::ParticleSolver<dim>>(std::move(state), std::move(force));
  body.zone->dashpots = std::move(dashpots);
  body.dt_zone =
      reference.value("stable_step", [&] { return body.force()->stable_step(body.zone->state); });
  if (faces)
    surface.add_particles(*faces, body.zone->state, contact_stiffness_of(scene), body.dt_zone);
  log.info("{} particles, {} bonds, {} faces cut by cracks, stable step {:.4g} s",
           body.zone->state.size(), body.force()->n_bonds(), body.n_cracked_faces, body.dt_zone);
}

template void make_zone(const Scene &, const ForceMaker<2> &, Reference &, CoupledBody<2> &,
                        ContactSurface<2> &, core::Log &);
template void make_zone(const Scene &, const ForceMaker<3> &, Reference &, CoupledBody<3> &,
                        ContactSurface<3> &, core::Log &);
} // namespace ligament::program
