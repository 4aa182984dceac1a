#include "coupling/zone_bath.h"

#include "core/exact_sum.h"

#include <cmath>
#include <numeric>

namespace ligament::coupling
{
template <int dim>
ZoneBath<dim>::ZoneBath(const Overlap<dim> &overlap, int n_particles)
{
  for (int i = 0; i < n_particles; ++i)
    if (overlap.member_of_particle[i] < 0)
      particles_.push_back(i);
}

template <int dim>
ZoneBath<dim>::ZoneBath(int n_particles) : particles_(n_particles)
{
  std::iota(particles_.begin(), particles_.end(), 0);
}

template <int dim>
void ZoneBath<dim>::exchange_heat(double kept, double thermal_energy,
                                  const core::ThermalNoise &noise, double dt,
                                  particles::Particles<dim> &p)
{
  core::ExactSum sum;
  for (const int i : particles_) {
    const double root = std::sqrt((1 - kept * kept) * thermal_energy / p.mass[i]);
    double twice = 0;
    for (int c = 0; c < dim; ++c) {
      const double old = p.velocity[c][i], half = 0.5 * dt * p.force[c][i] / p.mass[i],
                   v = kept * (old - half) + half + root * noise(p.global_id[i], c, 2);
      p.velocity[c][i] = v;
      twice += (old - v) * (p.mass[i] * (old + v) - dt * p.force[c][i]);
    }
    sum.add(twice);
  }
  taken += sum.value() / 2;
}

template <int dim>
void ZoneBath<dim>::draw(double thermal_energy, const core::ThermalNoise &noise,
                         particles::Particles<dim> &p) const
{
  for (int i = 0; i < p.size(); ++i)
    for (int c = 0; c < dim; ++c)
      p.velocity[c][i] = std::sqrt(thermal_energy / p.mass[i]) * noise(p.global_id[i], c, 3);
}

template <int dim>
double ZoneBath<dim>::kinetic_energy(const particles::Particles<dim> &p) const
{
  core::ExactSum sum;
  for (const int i : particles_)
    sum.add(p.mass[i] * get(p.velocity, i).squaredNorm() / 2);
  return sum.value();
}

template class ZoneBath<2>;
template class ZoneBath<3>;
} // namespace ligament::coupling
