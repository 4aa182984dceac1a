#include "src/scene/servo_scales.h"

#include <algorithm>
#include <functional>

namespace ligament::program
{
double servo_response(const Scene &scene, const ServoParameters &servo)
{
  if (servo.response_time > 0)
    return servo.response_time;
  const auto &material = scene.material;
  const double c_s =
      std::sqrt(material.youngs_modulus / (2 * (1 + material.poissons_ratio)) / material.density);
  Point size = scene.specimen.size;
  // The longest first; in 2D the last is 0.
  std::partial_sort(size.begin(), size.begin() + 2, size.end(), std::greater<>());
  constexpr double transits = 4;
  // Beams swing more slowly than waves cross them, by about their slenderness.
  return transits * size[0] / c_s * size[0] / size[1];
}

bool names_gauge(const ServoParameters &servo, const GaugeParameters &gauge)
{
  return !gauge.name.empty() &&
         (servo.gauge == gauge.name ||
          servo.gauge.compare(0, gauge.name.size() + 1, gauge.name + "_") == 0);
}

double servo_stiffness(const Scene &scene, const LoadParameters &load, int component)
{
  const bool has_own_name = load.boundary > 2 * scene.dimension;
  const int axis = has_own_name ? component : load.boundary / 2; // across the side
  const MaterialParameters &m = scene.material;
  const double modulus =
      axis == component ? m.youngs_modulus : m.youngs_modulus / (2 * (1 + m.poissons_ratio));
  return modulus / scene.specimen.size[axis];
}
} // namespace ligament::program
