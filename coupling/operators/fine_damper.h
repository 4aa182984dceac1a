// How strongly the fine damper acts across the overlap, the same for all schemes.
#pragma once

#include <cmath>

namespace ligament::coupling
{
/// c_f in 1/s of theory.md eq. (C11) at the relative position s in the overlap: 0 at the discrete
/// side, s = 1. `strength` is that of the scene, without unit; wave speed in m/s, cell size in m.
inline double fine_damper_rate(double strength, double wave_speed, double cell_size, double s)
{
  return strength * wave_speed / cell_size * std::pow(1 - s, 1.5);
}
} // namespace ligament::coupling
