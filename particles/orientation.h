// A particle takes the orientation that a rotation matrix says.
#pragma once

#include "particles/particles.h"

#include <Eigen/Geometry>

#include <cmath>

namespace ligament::particles
{
/// In 2D the angle nearest to the present one: angles are unwrapped.
template <int dim>
void set_orientation(Particles<dim> &particles, int i, const Eigen::Matrix<double, dim, dim> &r)
{
  if constexpr (dim == 2) {
    // Of the present angle only the number of whole turns enters: nothing else is remembered.
    double &angle = particles.rotation[0][i];
    const double in_one_turn = std::atan2(r(1, 0), r(0, 0));
    angle = in_one_turn + 2 * M_PI * std::round((angle - in_one_turn) / (2 * M_PI));
  } else {
    const Eigen::Quaterniond q(r);
    set(particles.rotation, i, Vec<4>(q.w(), q.x(), q.y(), q.z()));
  }
}
} // namespace ligament::particles
