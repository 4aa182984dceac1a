#include "coupling/coupler.h"

namespace ligament::coupling
{
template <int dim>
Coupler<dim>::Coupler(core::Timers &timers)
    : timers_(timers), forces_(timers.section("discrete forces")),
      motion_(timers.section("discrete motion")), far_(timers.section("far field")),
      coupling_(timers.section("coupling"))
{
}

template <int dim>
void Coupler<dim>::set_regime(Regime regime, Bodies<dim> &bodies)
{
  if (bodies.far && regime != Regime::linear)
    bodies.far->set_corotated(true);
}

template <int dim>
void Coupler<dim>::compute_trial(Bodies<dim> &bodies, double time, double noted_share,
                                 Components<dim> &nodal_force) const
{
  if (bodies.zone)
    bodies.zone->compute_trial(time, noted_share);
  if (bodies.far) {
    bodies.far->compute_trial(time);
    nodal_force = bodies.far->force;
  }
}

template <int dim>
void NullCoupler<dim>::drift(Bodies<dim> &bodies, const StepTime &step)
{
  if (bodies.zone) {
    const auto timing = this->timers_.scope(this->motion_);
    bodies.zone->drift(step.dt);
    bodies.zone->update_ghosts();
  }
  if (bodies.far) {
    const auto timing = this->timers_.scope(this->far_);
    bodies.far->drift(step.dt);
  }
}

template <int dim>
void NullCoupler<dim>::compute_forces(Bodies<dim> &bodies, const StepTime &step)
{
  if (bodies.zone) {
    const auto timing = this->timers_.scope(this->forces_);
    bodies.zone->compute_forces(step.time);
  }
  if (bodies.far) {
    const auto timing = this->timers_.scope(this->far_);
    bodies.far->compute_forces(step.time);
  }
}

template <int dim>
void NullCoupler<dim>::kick(Bodies<dim> &bodies, const StepTime &step)
{
  if (bodies.zone) {
    const auto timing = this->timers_.scope(this->motion_);
    bodies.zone->kick(step.dt);
  }
  if (bodies.far) {
    const auto timing = this->timers_.scope(this->far_);
    bodies.far->kick(step.dt, step.time);
  }
}

template <int dim>
void NullCoupler<dim>::scale_velocities(Bodies<dim> &bodies, double factor)
{
  if (bodies.zone)
    bodies.zone->scale_velocities(factor);
  if (bodies.far)
    bodies.far->scale_velocities(factor);
}

template <int dim>
double NullCoupler<dim>::damp_velocities(Bodies<dim> &bodies, const StepTime &step, double factor)
{
  double loss = 0;
  if (bodies.zone)
    loss += bodies.zone->ranks().sum(bodies.zone->damp_velocities(factor, step.dt)).value();
  if (bodies.far)
    loss += bodies.far->damp_velocities(step.dt);
  return loss;
}

template <int dim>
CoupledEnergy NullCoupler<dim>::energy(const Bodies<dim> &bodies, const StepTime &step) const
{
  CoupledEnergy e;
  if (bodies.zone) {
    e.kinetic_discrete = bodies.zone->kinetic_energy(step.dt);
    e.potential_discrete = bodies.zone->potential_energy();
  }
  if (bodies.far) {
    e.kinetic_far = bodies.far->kinetic_energy(step.dt);
    e.potential_far = bodies.far->potential_energy();
  }
  return e;
}

template class Coupler<2>;
template class Coupler<3>;
template class NullCoupler<2>;
template class NullCoupler<3>;
} // namespace ligament::coupling
