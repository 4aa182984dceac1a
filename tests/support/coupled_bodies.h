// Small coupled bodies for tests: a band whose overlap ends at free edges, a closed ring.
#pragma once

#include "coupling/bridging_domain.h"
#include "coupling/fine_scale_split.h"
#include "dem/many_body_force.h"
#include "packings/lattice_packing.h"

#include <chrono>
#include <cmath>
#include <optional>
#include <random>

namespace ligament::tests
{
template <int dim>
struct CoupledBodies
{
  std::unique_ptr<particles::ParticleSolver<dim>> zone;
  std::unique_ptr<fem::FemSolver<dim>> far;
  std::unique_ptr<coupling::FineScaleSplit<dim>> split; // one of the two
  std::unique_ptr<coupling::BridgingDomain<dim>> bridging;
  std::unique_ptr<core::Timers> timers = std::make_unique<core::Timers>();
  double dt = 0; // s, 0.9 of the plain discrete step unless asked otherwise
  double dt_zone = 0;
  double spacing = 1;
  double setup_time = 0; // s, of the coupler alone

  coupling::Bodies<dim> bodies() const { return {zone.get(), far.get()}; }
};

/// Everything in units of the spacing d = 1, E = 1, rho = 1.
template <int dim>
struct CoupledBodiesParameters
{
  dem::DemMaterial material;
  packings::LatticeKind kind =
      dim == 2 ? packings::LatticeKind::hexagonal : packings::LatticeKind::fcc;
  Spin<dim> orientation = Spin<dim>::Zero();
  Vector<dim> size;         // specimen, centred at the origin
  Vector<dim> zone_size;    // beyond the specimen: not coupled there
  core::BoxUnion<dim> zone; // in place of zone_size when it has boxes
  double cell_size = 4.1;   // h/d, incommensurate with the packing
  int overlap_cells = 3;
  int transition_cells = 6;
  int levels = 0;
  int fine_cells = 0; // 0: so many that hanging nodes keep off the transition
  double growth = 1;
  coupling::FineScaleSplitParameters split;
  std::optional<coupling::BridgingDomainParameters> bridging; // in place of the split
  coupling::WeightShape weight = coupling::WeightShape::cubic;
  double step_fraction = 0.9;
  /// Puts another law in the place of the many-body law; empty: keeps it.
  std::function<std::unique_ptr<particles::ParticleForce<dim>>(
      const particles::Particles<dim> &, std::unique_ptr<particles::ParticleForce<dim>>)>
      replace_law;
  /// Changes the far field's mesh before anything knows it; empty: leaves it.
  std::function<void(fem::Mesh<dim> &)> change_mesh;
};

template <int dim>
CoupledBodies<dim> make_coupled_bodies(const CoupledBodiesParameters<dim> &p)
{
  CoupledBodies<dim> body;
  packings::LatticeParameters<dim> lattice;
  lattice.kind = p.kind;
  lattice.spacing = 1;
  lattice.orientation = p.orientation;
  lattice.upper = p.size / 2;
  lattice.lower = -lattice.upper;
  fem::MeshParameters<dim> mesh;
  mesh.lower = lattice.lower;
  mesh.upper = lattice.upper;
  mesh.cell_size = p.cell_size;
  mesh.levels = p.levels;
  mesh.fine_cells = p.fine_cells > 0 ? p.fine_cells : p.overlap_cells + p.transition_cells + 2;
  mesh.growth = p.growth;
  coupling::OverlapParameters<dim> overlap;
  overlap.length = p.overlap_cells * p.cell_size;
  overlap.spacing = 1;
  overlap.transition_cells = p.transition_cells;
  overlap.zone = p.zone;
  if (p.zone.boxes.empty()) {
    auto &box = overlap.zone.boxes.emplace_back();
    box.upper = Vector<dim>::Constant(std::numeric_limits<double>::infinity());
    for (int c = 0; c < dim; ++c)
      if (p.zone_size[c] < p.size[c])
        box.upper[c] = p.zone_size[c] / 2;
    box.lower = -box.upper;
  }
  lattice.zone_lower = lattice.zone_upper = overlap.zone.boxes[0].lower;
  for (const auto &box : overlap.zone.boxes) {
    lattice.zone_lower = lattice.zone_lower.cwiseMin(box.lower);
    lattice.zone_upper = lattice.zone_upper.cwiseMax(box.upper);
  }
  lattice.zone_parts = p.zone;
  mesh.inner = overlap.zone.eroded(overlap.length).boxes;
  auto packing = packings::make_lattice_packing<dim>(lattice);
  particles::Particles<dim> state;
  packings::fill_particles(packing, p.material.density, state);
  std::unique_ptr<particles::ParticleForce<dim>> law = std::make_unique<dem::ManyBodyForce<dim>>(
      std::move(packing), p.material, std::vector<core::BoundaryLoad<dim>>());
  if (p.replace_law)
    law = p.replace_law(state, std::move(law));
  const auto constants = law->elastic_constants();
  body.zone = std::make_unique<particles::ParticleSolver<dim>>(std::move(state), std::move(law));
  fem::Body<dim> material;
  material.stiffness = constants.stiffness;
  material.stress = constants.stress;
  material.density = p.material.density;
  fem::Mesh<dim> far = fem::make_mesh(mesh);
  if (p.change_mesh)
    p.change_mesh(far);
  body.far = std::make_unique<fem::FemSolver<dim>>(std::move(far), material,
                                                   std::vector<core::BoundaryLoad<dim>>());
  auto bodies = body.bodies();
  const auto timed = [&](auto &&set_up) {
    const auto start = std::chrono::steady_clock::now();
    set_up();
    body.setup_time =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  if (p.bridging)
    timed([&] {
      overlap.shape = p.weight;
      body.bridging = std::make_unique<coupling::BridgingDomain<dim>>(bodies, overlap, *p.bridging,
                                                                      *body.timers);
    });
  body.dt_zone = body.zone->force->stable_step(body.zone->state);
  body.dt = p.step_fraction * body.dt_zone;
  if (p.bridging)
    return body;
  timed([&] {
    body.split = std::make_unique<coupling::FineScaleSplit<dim>>(bodies, overlap, p.split, body.dt,
                                                                 *body.timers);
  });
  return body;
}

/// One step of the time loop, theory.md "One step".
template <int dim>
void advance(CoupledBodies<dim> &body, coupling::StepTime &time)
{
  auto bodies = body.bodies();
  body.split->compute_forces(bodies, time);
  body.split->kick(bodies, time);
  body.split->drift(bodies, time);
  ++time.step;
  time.time += time.dt;
}
} // namespace ligament::tests
