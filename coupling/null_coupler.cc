#include "coupling/coupler.h"

namespace ligament::coupling
{
template <int dim>
void NullCoupler<dim>::drift(Bodies<dim> &bodies, const StepTime &step)
{
  if (bodies.zone)
  {
    bodies.zone->drift(step.dt);
    bodies.zone->update_ghosts();
  }
  if (bodies.far)
    bodies.far->drift(step.dt);
}

template <int dim>
void NullCoupler<dim>::compute_forces(Bodies<dim> &bodies, const StepTime &step)
{
  if (bodies.zone)
    bodies.zone->compute_forces(step.time);
  if (bodies.far)
    bodies.far->compute_forces(step.time);
}

template <int dim>
void NullCoupler<dim>::kick(Bodies<dim> &bodies, const StepTime &step)
{
  if (bodies.zone)
    bodies.zone->kick(step.dt);
  if (bodies.far)
    bodies.far->kick(step.dt, step.time);
}

template <int dim>
void NullCoupler<dim>::scale_velocities(Bodies<dim> &bodies, double factor)
{
  const auto scale = [factor](auto &components) {
    for (auto &array : components)
      for (double &v : array)
        v *= factor;
  };
  if (bodies.zone)
  {
    scale(bodies.zone->state.velocity);
    scale(bodies.zone->state.spin);
  }
  if (bodies.far)
    scale(bodies.far->velocity);
}

template <int dim>
CoupledEnergy NullCoupler<dim>::energy(const Bodies<dim> &bodies, const StepTime &step) const
{
  CoupledEnergy e;
  if (bodies.zone)
  {
    e.kinetic_discrete = bodies.zone->kinetic_energy(step.dt);
    e.potential_discrete = bodies.zone->potential_energy();
  }
  if (bodies.far)
  {
    e.kinetic_far = bodies.far->kinetic_energy(step.dt);
    e.potential_far = bodies.far->potential_energy();
  }
  return e;
}

template class NullCoupler<2>;
template class NullCoupler<3>;
} // namespace ligament::coupling
