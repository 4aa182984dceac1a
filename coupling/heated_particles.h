// Particles without a mesh, in a heat bath.
#pragma once

#include "coupling/coupler.h"
#include "coupling/zone_bath.h"

namespace ligament::coupling
{
/// All particles have the friction and the noise of theory.md eq. (C29); without friction they keep
/// the heat that they begin with.
template <int dim>
class HeatedParticles : public NullCoupler<dim>
{
public:
  struct Parameters
  {
    double thermal_energy = 0; // kT, J
    double friction = 0;       // 1/s
    std::int64_t seed = 1;
  };
  HeatedParticles(const Bodies<dim> &bodies, const Parameters &parameters, core::Timers &timers)
      : NullCoupler<dim>(timers), parameters_(parameters), bath_(bodies.zone->state.size())
  {
  }

  /// Velocities of twice the temperature: half of their energy becomes strain.
  void start(Bodies<dim> &bodies);

  void kick(Bodies<dim> &bodies, const StepTime &step) override;
  CoupledEnergy energy(const Bodies<dim> &bodies, const StepTime &step) const override;
  std::array<double, 3> thermal_energies(const Bodies<dim> &bodies) const override;
  bool can_rest() const override { return false; }
  void save(core::State &state, const Bodies<dim> &bodies) const override;
  void load(const core::State &state, Bodies<dim> &bodies) override;

private:
  Parameters parameters_;
  ZoneBath<dim> bath_;
};
} // namespace ligament::coupling
