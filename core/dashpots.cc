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

double layer_rate(double depth, double width, double speed)
{
  constexpr double strength = 6;
  const double x = std::clamp(depth / width, 0., 1.);
  return strength * speed / width * x * x;
}

template class Dashpots<2>;
template class Dashpots<3>;
} // namespace ligament::core
