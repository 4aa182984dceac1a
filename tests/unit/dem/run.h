// A body that takes steps, and its energy balance.
#pragma once

#include "dem/many_body_force.h"
#include "packings/lattice_packing.h"
#include "particles/particle_solver.h"

namespace ligament::dem::testing
{
using particles::Particles;

template <int dim>
struct Run
{
  Run(const packings::Packing<dim> &packing, const Materials &materials,
      const std::vector<core::BoundaryLoad<dim>> &loads, const FractureLaw &law = {})
  {
    Particles<dim> p;
    packings::fill_particles(packing, materials.base().density, p);
    auto f = std::make_unique<ManyBodyForce<dim>>(packing, materials, loads, law);
    force = f.get();
    solver = std::make_unique<particles::ParticleSolver<dim>>(std::move(p), std::move(f));
    dt = force->stable_step(solver->state);
    solver->compute_forces(0);
  }
  /// `damping` in 1/s is booked by theory.md eq. (E3).
  void step(double damping = 0)
  {
    const auto loss = [&](auto &velocity, const auto &force, double moment) {
      const double factor = std::exp(-damping * dt);
      double sum = 0;
      for (std::size_t c = 0; c < velocity.size(); ++c)
        for (int i = 0; i < solver->state.size(); ++i) {
          const double mass = moment * solver->state.mass[i], v = velocity[c][i];
          sum += 0.5 * mass * (1 - factor) * v * (v - dt * force[c][i] / mass + factor * v);
        }
      return sum;
    };
    solver->kick(dt);
    if (damping > 0) {
      const auto &p = solver->state;
      damped += loss(p.velocity, p.force, 1.) + loss(p.spin, p.torque, p.gyration);
      solver->scale_velocities(std::exp(-damping * dt));
    }
    solver->drift(dt);
    time += dt;
    solver->compute_forces(time);
  }
  double mechanical() const { return solver->kinetic_energy(dt) + solver->potential_energy(); }
  double residual() const
  {
    return mechanical() + force->fracture_energy() + force->cohesive_work() +
           force->breaking_step_error() + force->frictional_work() + damped +
           force->rebonding_energy() -
           force->external_work();
  }

  ManyBodyForce<dim> *force;
  std::unique_ptr<particles::ParticleSolver<dim>> solver;
  double dt, time = 0, damped = 0;
};
} // namespace ligament::dem::testing
