#include "src/simulation/make_zone.h"

#include "core/check.h"
#include "fem/body.h"
#include "packings/absorbing_sides.h"
#include "packings/outer_face.h"
#include "src/scene/geometry.h"
#include "src/simulation/make_loads.h"
#include "src/simulation/make_packing.h"
#include "src/simulation/tools/make_tools.h"
#include "src/simulation/toughness_cache.h"

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

/// What the coupler sums cell by cell is stepped cell by cell.
template <int dim>
packings::Groups<dim> cells_of_overlap(const Scene &scene, const CoupledBody<dim> &body)
{
  packings::Groups<dim> cells;
  if (!body.far || scene.coupling.scheme == coupling::Scheme::none)
    return cells;
  const fem::Mesh<dim> &mesh = body.far->mesh();
  cells.of = [locator = std::make_shared<fem::CellLocator<dim>>(mesh)](const Vector<dim> &x) {
    return locator->find(x);
  };
  const auto zone = zone_shape<dim>(scene);
  for (int c = 0; c < mesh.n_cells(); ++c)
    if (const Vector<dim> &lower = mesh.cell_lower[c], upper = lower + mesh.cell_size[c];
        zone.meets(lower, upper, 0))
      cells.reach = std::max(cells.reach, mesh.cell_size[c].maxCoeff());
  return cells;
}

/// Of one process the whole.
template <int dim>
PartOfZone<dim> pack_part(const Scene &scene, Reference &reference, const core::Ranks &ranks,
                          const packings::Groups<dim> &cells,
                          const std::vector<std::int64_t> &weights, core::Log &log)
{
  if (!ranks.is_one())
    return make_packing_part<dim>(scene, reference, ranks, ghost_rings<dim>(scene), log, cells,
                                  weights);
  auto [packing, seeds, n_healed] = make_packing<dim>(scene, reference, log);
  PartOfZone<dim> zone;
  zone.seeds = std::move(seeds);
  zone.n_healed = n_healed;
  zone.held.part = particles::Part::whole(packing.size());
  zone.held.n_whole = packing.size();
  zone.held.packing = std::move(packing);
  return zone;
}

/// Areas in m^2 of the faces on which each load acts, of the body.
template <int dim>
std::vector<double> loaded_areas(const CoupledBody<dim> &body,
                                 const packings::PackingPart<dim> &held)
{
  std::vector<core::ExactSum> areas(body.loads.size());
  for (const auto &face : held.packing.boundary_faces)
    for (std::size_t l = 0; l < body.loads.size(); ++l)
      if (face.boundary == body.loads[l].boundary && held.part.owns(face.i))
        if (const auto inside =
                packings::OuterFace<dim>(face, held.packing).inside({body.loads[l].part}))
          areas[l].add(inside->area);
  std::vector<double> values;
  for (const core::ExactSum &area : body.ranks.sum(areas))
    values.push_back(area.value());
  return values;
}

/// Particles on what a traction on a side with a name acts on, and their neighbours, of each load.
template <int dim>
std::vector<std::vector<int>> load_layers(const CoupledBody<dim> &body,
                                          const packings::Packing<dim> &packing)
{
  std::vector<std::vector<int>> layers(body.loads.size());
  for (std::size_t l = 0; l < body.loads.size(); ++l) {
    const auto &load = body.loads[l];
    if (load.boundary <= inner_surface<dim> || load.kind != core::BoundaryLoad<dim>::Kind::traction)
      continue;
    std::vector<char> is_loaded(packing.size(), 0);
    for (const auto &face : packing.boundary_faces)
      if (face.boundary == load.boundary && !is_loaded[face.i] &&
          packings::OuterFace<dim>(face, packing).inside({load.part}))
        is_loaded[face.i] = 1;
    std::vector<char> is_in = is_loaded;
    for (const auto &face : packing.faces)
      if (is_loaded[face.i] || is_loaded[face.j])
        is_in[face.i] = is_in[face.j] = 1;
    for (int i = 0; i < packing.size(); ++i)
      if (is_in[i])
        layers[l].push_back(i);
  }
  return layers;
}

/// The loads as the zone meets them. Atoms near a side share all of it alike, those near a part of
/// it have its area to a spacing: with what the mesh bears, whose share is exact, the forces of
/// scenes are met all the same.
template <int dim>
std::vector<core::BoundaryLoad<dim>> loads_of_zone(const Scene &scene, const CoupledBody<dim> &body)
{
  auto loads = body.loads;
  for (std::size_t l = 0; scene.atoms && l < scene.loads.size(); ++l) {
    if (scene.loads[l].kind != LoadKind::force || body.loaded_faces[l] <= 0)
      continue;
    const double of_mesh = body.far ? body.far->loaded_area(int(l)) : 0;
    const double share = (body.load_places[l].area - of_mesh) / body.loaded_faces[l];
    for (auto &component : loads[l].value)
      if (component)
        *component *= share;
  }
  return loads;
}

/// As those of the mesh: in a crystal they depend on the side. Of absorbing sides alone: a crystal
/// under stress need not have any across the others.
template <int dim>
packings::SideMedium<dim> side_medium(const particles::ElasticConstants<dim> &constants,
                                      double density,
                                      const std::vector<core::BoundaryLoad<dim>> &loads)
{
  const fem::Body<dim> solid{constants.stiffness, density, 1, constants.stress};
  packings::SideMedium<dim> medium = {density, {}};
  for (const auto &load : loads)
    if (load.absorbing)
      medium.speeds.across[load.boundary / 2] = fem::normal_wave_speeds(solid, load.boundary / 2);
  return medium;
}

/// Of the scene's material and of each inclusion, which may lie at a side; of atoms the crystal.
template <int dim>
std::vector<packings::SideMedium<dim>> side_media(const Scene &scene,
                                                  const particles::ElasticConstants<dim> &constants,
                                                  const std::vector<core::BoundaryLoad<dim>> &loads)
{
  std::vector<packings::SideMedium<dim>> media = {
      side_medium(constants, scene.material.density, loads)};
  for (const Inclusion &inclusion : scene.inclusions)
    media.push_back(side_medium(elastic_constants_of<dim>(scene, inclusion.material),
                                inclusion.material.density, loads));
  return media;
}

/// Faces that initial cracks cut, of the body.
template <int dim>
std::vector<BrokenBond> all_cut_faces(const CoupledBody<dim> &body,
                                      const packings::PackingPart<dim> &held)
{
  std::vector<BrokenBond> cut;
  for (const auto &face : held.packing.faces)
    if (face.cracked && held.part.owns(face.i))
      cut.push_back(cut_face<dim>(held.packing, face, body.thickness));
  return body.ranks.gather_all(cut);
}

/// Likewise of atoms: pairs of nearest neighbours, which their force knows.
template <int dim>
std::vector<BrokenBond> all_cut_pairs(const CoupledBody<dim> &body)
{
  const auto &atoms = body.zone->state;
  std::vector<BrokenBond> cut;
  body.force()->for_each_face(atoms, [&](const particles::FaceView<dim> &face) {
    if (face.bonded || face.i >= face.j || !atoms.part.owns(face.i))
      return;
    cut.push_back({});
    cut.back().i = atoms.global_id[face.i];
    cut.back().j = atoms.global_id[face.j];
    for (int c = 0; c < dim; ++c) {
      cut.back().centroid[c] = face.centroid[c];
      cut.back().normal[c] = face.normal[c];
    }
    cut.back().size = face.area / body.thickness;
  });
  return body.ranks.gather_all(cut);
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

namespace
{
/// What particles are made of: all but the faces between them, which most of a packing is.
template <int dim>
packings::Packing<dim> without_faces(packings::Packing<dim> &packing)
{
  auto faces = std::move(packing.faces);
  packing.faces.clear();
  packings::Packing<dim> cells = packing;
  packing.faces = std::move(faces);
  return cells;
}

/// Whole on every rank: the operators of the overlap are the same on all.
template <int dim>
void make_whole_overlap(const Scene &scene, const ForceMaker<dim> &make_force,
                        std::optional<packings::Packing<dim>> overlap,
                        const packings::Groups<dim> &cells, CoupledBody<dim> &body)
{
  core::Log nothing_new;
  auto packing =
      overlap ? *std::move(overlap)
              : packings::make_grouped_lattice<dim>(lattice_of<dim>(scene), body.ranks.size(),
                                                    cells, ghost_rings<dim>(scene));
  particles::Particles<dim> state;
  packings::fill_particles(packing, scene.densities(), state);
  auto figures = body.figures; // known already
  auto force = make_force(scene, std::move(packing), body.loads, figures, nothing_new);
  body.whole_overlap =
      std::make_unique<particles::ParticleSolver<dim>>(std::move(state), std::move(force));
}
} // namespace

template <int dim>
void make_zone(const Scene &scene, const ForceMaker<dim> &make_force, Reference &reference,
               const std::vector<std::int64_t> &weights, CoupledBody<dim> &body,
               ContactSurface<dim> &surface, core::Log &log)
{
  const auto cells = cells_of_overlap(scene, body);
  auto [held, seeds, n_healed, overlap] =
      pack_part<dim>(scene, reference, body.ranks, cells, weights, log);
  packings::Packing<dim> &packing = held.packing;
  body.seeds = std::move(seeds);
  if (n_healed)
    body.figures["healed_radii"] = {double(*n_healed), ""};
  body.n_particles = held.n_whole;
  body.loaded_faces = loaded_areas(body, held);
  body.load_layers = load_layers(body, packing);
  body.cut_faces = all_cut_faces(body, held);
  body.n_cracked_faces = std::int64_t(body.cut_faces.size());
  const auto constants = elastic_constants_of<dim>(scene);
  for (const std::string &name : reference.names(calibrated))
    body.figures[name] = {reference.value(name, {}), ""};
  std::optional<packings::Packing<dim>> faces; // the force uses the packing up
  if (!scene.tools.empty())
    faces = packing;
  // Particles come when the faces are gone.
  packings::Packing<dim> of_particles = without_faces(packing);
  auto force = make_force(scene, std::move(packing), loads_of_zone(scene, body), body.figures, log);
  for (const auto &[name, figure] : body.figures)
    if (name.compare(0, calibrated.size(), calibrated) == 0) {
      body.ranks.agree_on("the " + name + " (kept in " + ToughnessCache::default_folder() + ")",
                          figure.value); // a folder of each machine may hold another one's
      reference.value(name, [&value = figure.value] { return value; });
    }
  require_same_solid(force->elastic_constants(), constants);
  particles::Particles<dim> state;
  packings::fill_particles(of_particles, scene.densities(), state);
  state.part = held.part;
  auto dashpots = packings::absorbing_dashpots(
      of_particles, state, body.loads, side_media(scene, constants, body.loads), body.ranks);
  of_particles = {};
  body.zone = std::make_unique<particles::ParticleSolver<dim>>(std::move(state), std::move(force));
  body.zone->dashpots = std::move(dashpots);
  if (scene.atoms) {
    body.cut_faces = all_cut_pairs(body);
    body.n_cracked_faces = std::int64_t(body.cut_faces.size());
  }
  if (!body.ranks.is_one())
    body.zone->join({body.ranks, held.owner});
  if (!body.ranks.is_one() && cells.of)
    make_whole_overlap(scene, make_force, std::move(overlap), cells, body);
  body.dt_zone =
      reference.value("stable_step", [&] { return body.force()->stable_step(body.zone->state); });
  if (faces)
    surface.add_particles(*faces, body.zone->state, contact_stiffness_of(scene), body.dt_zone);
  const auto most =
      body.ranks.max({particles::count(held.part.owned), body.zone->halo().n_ghosts()});
  const std::string where = body.ranks.is_one() ? fmt::format("{} bonds", body.force()->n_bonds())
                                                : fmt::format("on {} ranks up to {} and {} ghosts",
                                                              body.ranks.size(), most[0], most[1]);
  log.info("{} particles, {}, {} faces cut by cracks, stable step {:.4g} s", body.n_particles,
           where, body.n_cracked_faces, body.dt_zone);
}

template void make_zone(const Scene &, const ForceMaker<2> &, Reference &,
                        const std::vector<std::int64_t> &, CoupledBody<2> &, ContactSurface<2> &,
                        core::Log &);
template void make_zone(const Scene &, const ForceMaker<3> &, Reference &,
                        const std::vector<std::int64_t> &, CoupledBody<3> &, ContactSurface<3> &,
                        core::Log &);
} // namespace ligament::program
