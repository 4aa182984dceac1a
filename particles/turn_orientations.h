// Turns of all orientations by their spins, vectorised.
#pragma once

#include <array>

namespace ligament::particles
{
/// q <- exp(dt w / 2) q for n unit quaternions (w, x, y, z) and spins in rad/s, renormalised.
void turn_orientations(const std::array<double *, 4> &quaternion,
                       const std::array<const double *, 3> &spin, double dt, int n);
} // namespace ligament::particles
