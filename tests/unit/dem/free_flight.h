// Free flight of a body that starts stretching and spinning: does its energy add up?
#pragma once

#include "particles/particle_solver.h"
#include "tests/unit/dem/body.h"

namespace ligament::dem::testing
{
/// Energies in J: at the start, what is missing of it at the end, what was taken.
struct Flight
{
  double start, missing;
  particles::ForceLosses losses;
};

/// It stretches along x at a rate of 3 `scale` per spacing, with noise of a twentieth of `scale`;
/// steps are this fraction of the stable one. `look` sees the force at the end.
template <int dim>
Flight fly(const Packing<dim> &packing, const Materials &materials, double scale, int n_steps,
           double fraction = 0.8, const FractureLaw &fracture = {},
           const std::function<void(const ManyBodyForce<dim> &)> &look = {})
{
  Particles<dim> p;
  packings::fill_particles(packing, materials.base().density, p);
  auto f = std::make_unique<ManyBodyForce<dim>>(packing, materials,
                                                std::vector<core::BoundaryLoad<dim>>(), fracture);
  auto &force = *f;
  particles::ParticleSolver<dim> solver(std::move(p), std::move(f));
  const double dt = fraction * force.stable_step(solver.state);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < solver.state.size(); ++i) {
    const double x = solver.state.reference[0][i] / packing.spacing;
    solver.state.velocity[0][i] = scale * (3 * x + 0.05 * uniform(random));
    solver.state.velocity[1][i] = 0.05 * scale * uniform(random);
    for (auto &spin : solver.state.spin)
      spin[i] = 0.05 * scale * uniform(random) / packing.spacing;
  }
  double time = 0;
  solver.compute_forces(time);
  const double start = solver.kinetic_energy(dt);
  for (int s = 0; s < n_steps; ++s) {
    solver.kick(dt);
    solver.drift(dt);
    solver.compute_forces(time += dt);
  }
  if (look)
    look(force);
  const auto losses = force.losses();
  return {start,
          solver.kinetic_energy(dt) + solver.potential_energy() + losses.plastic + losses.viscous +
              losses.fracture + losses.breaking_step_error + losses.friction + losses.cohesive - start,
          losses};
}
} // namespace ligament::dem::testing
