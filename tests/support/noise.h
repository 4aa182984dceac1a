// What the energy of a coupled body does while it moves as noise.
#pragma once

#include "tests/support/coupled_bodies.h"

#include <random>

namespace ligament::tests
{
/// A step operator that isn't symmetric pumps energy: noise tells, a patch test doesn't. Returns
/// the change of the block-averaged invariant from the first to the last tenth of the run of a body
/// that has no dampers.
template <int dim>
double drift_of_noise(CoupledBodies<dim> body, double speed, int n_steps)
{
  auto bodies = body.bodies();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-speed, speed);
  for (int c = 0; c < dim; ++c)
    for (int i = 0; i < body.zone->state.size(); ++i)
      body.zone->state.velocity[c][i] = uniform(random);
  for (int c = 0; c < dim; ++c)
    for (double &v : body.far->velocity[c])
      v = uniform(random);
  body.far->distribute();
  body.split->take_velocities(bodies);
  coupling::StepTime time;
  time.dt = body.dt;
  std::vector<double> block(10, 0.);
  const int per_block = n_steps / 10, sample = body.split->step_ratio() * 10;
  for (double &mean : block) {
    int n = 0;
    for (int k = 0; k < per_block; ++k) {
      body.split->compute_forces(bodies, time);
      if (time.step % sample == 0) {
        const auto e = body.split->energy(bodies, time);
        mean += e.kinetic_discrete + e.kinetic_far + e.potential_discrete + e.potential_far +
                e.blended + e.impulses - body.far->external_work();
        ++n;
      }
      body.split->kick(bodies, time);
      body.split->drift(bodies, time);
      ++time.step;
      time.time += time.dt;
    }
    mean /= n;
  }
  return (block.back() - block.front()) / block.front();
}

/// Of a body without dampers.
template <int dim>
double drift_of_noise(CoupledBodiesParameters<dim> p, double speed, int n_steps)
{
  p.split.fine_damper = 0;
  p.split.gap_filter = 0;
  return drift_of_noise(make_coupled_bodies(p), speed, n_steps);
}
} // namespace ligament::tests
