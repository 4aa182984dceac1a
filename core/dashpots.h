// Dashpots between a body and the ground: how a side of the specimen lets waves out.
#pragma once

#include "core/types.h"

#include <map>

namespace ligament::core
{
/// Forces -c v on single components of the velocity of particles or nodes. They act on the mean of
/// the velocities before and after the kick, (v(-) + v(+))/2, which leaves the stable step of the
/// leap-frog as it is and books their energy exactly (theory.md eqs. (A2), (A3)).
template <int dim>
class Dashpots
{
public:
  /// c in kg/s of {index, component}.
  using Coefficients = std::map<std::array<int, 2>, double>;

  Dashpots() = default;
  explicit Dashpots(const Coefficients &coefficients);

  /// From velocities after the kick v += dt force / mass to those that the dashpots leave;
  /// inverse_mass(index) in 1/kg, 0 for what is held.
  template <typename InverseMass>
  void act(double dt, const InverseMass &inverse_mass, const Components<dim> &force,
           Components<dim> &velocity);

  /// Taken so far, in J.
  double energy() const { return energy_; }

private:
  struct Dashpot
  {
    int index, component;
    double coefficient;
  };
  std::vector<Dashpot> dashpots_;
  double energy_ = 0;
};

template <int dim>
template <typename InverseMass>
void Dashpots<dim>::act(double dt, const InverseMass &inverse_mass, const Components<dim> &force,
                        Components<dim> &velocity)
{
  for (const Dashpot &d : dashpots_) {
    double &v = velocity[d.component][d.index];
    const double w = inverse_mass(d.index), ratio = 0.5 * dt * d.coefficient * w;
    // v(+) + v(-) = (v* + v(-))/(1 + ratio), v* the velocity that the kick has left.
    const double twice_mean = (2 * v - dt * force[d.component][d.index] * w) / (1 + ratio);
    v -= ratio * twice_mean;
    energy_ += dt * d.coefficient * twice_mean * twice_mean / 4;
  }
}

/// Damping rate of an absorbing layer in 1/s, `depth` m inside its inner border: rises with the
/// square of the depth (theory.md eq. (A4)). Waves of `speed` m/s are those along its normal.
double layer_rate(double depth, double width, double speed);
} // namespace ligament::core
