// A heat bath for the particles outside the overlap.
#pragma once

#include "core/thermal_noise.h"
#include "coupling/overlap.h"

namespace ligament::coupling
{
/// Friction and its noise on particles one by one (theory.md eq. (C29)), exact for any friction.
template <int dim>
class ZoneBath
{
public:
  ZoneBath(const Overlap<dim> &overlap, int n_particles);
  /// On all particles.
  explicit ZoneBath(int n_particles);

  /// v <- kept v + noise of thermal energy kT (J), v as half-way through the last kick, of the step
  /// dt and the present forces; stream 2.
  void exchange_heat(double kept, double thermal_energy, const core::ThermalNoise &noise, double dt,
                     particles::Particles<dim> &particles);
  /// Velocities of this thermal energy for all particles, whatever they were; stream 3.
  void draw(double thermal_energy, const core::ThermalNoise &noise,
            particles::Particles<dim> &particles) const;

  /// sum m v^2/2 in J.
  double kinetic_energy(const particles::Particles<dim> &particles) const;
  /// Components of velocities.
  long n_free() const { return dim * long(particles_.size()); }

  double taken = 0; // J so far, less what was given

private:
  std::vector<int> particles_;
};
} // namespace ligament::coupling
