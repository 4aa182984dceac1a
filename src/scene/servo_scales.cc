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

const GaugeParameters *followed_gauge(const Scene &scene, const ServoParameters &servo)
{
  const GaugeParameters *found = nullptr;
  for (const GaugeParameters &gauge : scene.gauges) {
    const bool is_named = servo.gauge == gauge.name || servo.gauge.rfind(gauge.name + "_", 0) == 0;
    if (!gauge.name.empty() && is_named && (!found || gauge.name.size() > found->name.size()))
      found = &gauge;
  }
  return found;
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
