#include "coupling/heated_particles.h"

#include <cmath>

namespace ligament::coupling
{
template <int dim>
void HeatedParticles<dim>::start(Bodies<dim> &bodies)
{
  bath_.draw(2 * parameters_.thermal_energy, core::ThermalNoise(parameters_.seed, -1),
             bodies.zone->state);
}

template <int dim>
void HeatedParticles<dim>::kick(Bodies<dim> &bodies, const StepTime &step)
{
  NullCoupler<dim>::kick(bodies, step);
  if (parameters_.friction == 0)
    return;
  const auto timing = this->timers_.scope(this->coupling_);
  bath_.exchange_heat(std::exp(-parameters_.friction * step.dt), parameters_.thermal_energy,
                      core::ThermalNoise(parameters_.seed, step.step), step.dt, bodies.zone->state);
}

template <int dim>
CoupledEnergy HeatedParticles<dim>::energy(const Bodies<dim> &bodies, const StepTime &step) const
{
  CoupledEnergy e = NullCoupler<dim>::energy(bodies, step);
  e.thermostat = bath_.taken;
  return e;
}

template <int dim>
std::array<double, 3> HeatedParticles<dim>::thermal_energies(const Bodies<dim> &bodies) const
{
  return {2 * bath_.kinetic_energy(bodies.zone->state) / double(bath_.n_free())};
}

template <int dim>
void HeatedParticles<dim>::save(core::State &state, const Bodies<dim> &) const
{
  core::save_value(state, "split", "zone_bath_energy", bath_.taken);
}

template <int dim>
void HeatedParticles<dim>::load(const core::State &state, Bodies<dim> &)
{
  bath_.taken = core::load_real(state, "split", "zone_bath_energy");
}

template class HeatedParticles<2>;
template class HeatedParticles<3>;
} // namespace ligament::coupling
