// What a step of a body costs, measured.
#pragma once

#include "src/simulation/coupled_body.h"

namespace ligament::program
{
struct StepCost
{
  double seconds_per_step = 0; // of the whole body
  double discrete_share = 0;   // of it, particles alone
  double mesh_share = 0;       // of it, far field and overlap

  /// Time of pure discrete elements over that of this body, at the same cost per particle.
  double saving(std::int64_t equivalent_particles, std::int64_t particles) const
  {
    return discrete_share * double(equivalent_particles) / double(particles);
  }
};

/// Steps the body at rest for so many seconds: the same work per step as in the run. `timers` are
/// those of the body.
template <int dim>
StepCost measure_step_cost(const Scene &scene, CoupledBody<dim> &body, core::Timers &timers,
                           double seconds);
} // namespace ligament::program
