// Whether the forces of a coupled body are the slope of its energy.
#pragma once

#include "tests/support/coupled_bodies.h"

#include <random>

namespace ligament::tests
{
template <int dim>
double potential(CoupledBodies<dim> &body, coupling::StepTime step)
{
  auto bodies = body.bodies();
  body.split->compute_forces(bodies, step);
  const auto e = body.split->energy(bodies, step);
  return e.potential_discrete + e.potential_far + e.blended;
}

template <int dim>
double kinetic(CoupledBodies<dim> &body, double dt)
{
  auto bodies = body.bodies();
  const auto e = body.split->energy(bodies, {0, 0, dt});
  return e.kinetic_discrete + e.kinetic_far;
}

/// With the velocities of half a step before, the kinetic energy of (E1) is 1/2 v M v + 1/2 dt v F:
/// its change with dt is the power of the forces, which must be what the energy loses.
template <int dim>
double power_error(CoupledBodies<dim> &body)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  auto bodies = body.bodies();
  const auto fill = [&](auto &components) {
    for (auto &component : components)
      for (double &v : component)
        v = uniform(random);
  };
  fill(body.zone->state.velocity);
  fill(body.zone->state.spin);
  fill(body.far->velocity);
  body.split->take_velocities(bodies);
  coupling::StepTime step;
  potential(body, step); // forces
  const double power = 2 * (kinetic(body, 1.) - kinetic(body, 0.));
  const double epsilon = 1e-6;
  step.dt = epsilon;
  body.split->drift(bodies, step);
  const double after = potential(body, step);
  step.dt = -2 * epsilon;
  body.split->drift(bodies, step);
  const double before = potential(body, step);
  return (after - before) / (2 * epsilon) / power + 1;
}
} // namespace ligament::tests
