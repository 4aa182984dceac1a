// A finite rotation as the force needs it: turned vectors, and their change without cancellation.
#pragma once

#include "particles/particles.h"

#include <Eigen/Geometry>

#include <cmath>

namespace ligament::dem
{
template <int dim>
struct Turn;

template <>
struct Turn<2>
{
  double cosine_minus_1 = 0, sine = 0;

  static Turn of(const particles::Particles<2> &p, int i)
  {
    const double angle = p.rotation[0][i], half = std::sin(angle / 2);
    return {-2 * half * half, std::sin(angle)};
  }
  Turn inverse() const { return {cosine_minus_1, -sine}; }
  /// (R - I) a
  Vector<2> change(const Vector<2> &a) const
  {
    return {cosine_minus_1 * a[0] - sine * a[1], cosine_minus_1 * a[1] + sine * a[0]};
  }
};

template <>
struct Turn<3>
{
  double w = 1;
  Vector<3> v = Vector<3>::Zero();

  static Turn of(const particles::Particles<3> &p, int i)
  {
    return {p.rotation[0][i], {p.rotation[1][i], p.rotation[2][i], p.rotation[3][i]}};
  }
  Turn inverse() const { return {w, -v}; }
  /// (R - I) a
  Vector<3> change(const Vector<3> &a) const
  {
    const Vector<3> t = 2 * v.cross(a);
    return w * t + v.cross(t);
  }
};

/// a x b; in 2D the component out of the plane.
inline Spin<2> cross(const Vector<2> &a, const Vector<2> &b)
{
  return Spin<2>(a[0] * b[1] - a[1] * b[0]);
}
inline Spin<3> cross(const Vector<3> &a, const Vector<3> &b)
{
  return a.cross(b);
}
} // namespace ligament::dem
