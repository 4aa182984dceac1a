#include "core/dashpots.h"

#include <algorithm>

namespace ligament::core
{
template <int dim>
Dashpots<dim>::Dashpots(const Coefficients &coefficients)
{
  for (const auto &[place, coefficient] : coefficients)
    if (coefficient > 0)
      dashpots_.push_back({place[0], place[1], coefficient});
}

template <int dim>
void Dashpots<dim>::act(double dt, const std::vector<double> &inverse_mass,
                        const Components<dim> &force, Components<dim> &velocity)
{
  for (const Dashpot &d : dashpots_) {
    double &v = velocity[d.component][d.index];
    const double w = inverse_mass[d.index], ratio = 0.5 * dt * d.coefficient * w;
    // v(+) + v(-) = (v* + v(-))/(1 + ratio), v* the velocity that the kick has left.
    const double twice_mean = (2 * v - dt * force[d.component][d.index] * w) / (1 + ratio);
    v -= ratio * twice_mean;
    energy_ += dt * d.coefficient * twice_mean * twice_mean / 4;
  }
}

double layer_rate(double depth, double width, double speed)
{
  constexpr double strength = 6;
  const double x = std::clamp(depth / width, 0., 1.);
  return strength * speed / width * x * x;
}

template class Dashpots<2>;
template class Dashpots<3>;
} // namespace ligament::core
