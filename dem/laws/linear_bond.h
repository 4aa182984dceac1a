// The elastic bond about the reference: how a small motion of its particles opens and turns it.
#pragma once

#include "dem/bond.h"

namespace ligament::dem
{
/// Rows of omega x a = -a x omega: how a rotation vector moves the tip of a lever.
inline Eigen::Matrix<double, 2, 1> tip_rows(const Vector<2> &a)
{
  return {-a[1], a[0]};
}
inline Eigen::Matrix<double, 3, 3> tip_rows(const Vector<3> &a)
{
  Eigen::Matrix<double, 3, 3> m;
  m << 0, a[2], -a[1], -a[2], 0, a[0], a[1], -a[0], 0;
  return m;
}

/// Du of eq. (D7) is the sum over both sides (sign -1 of i, 1 of j) of these rows times the degrees
/// of freedom of the particle.
template <int dim>
Eigen::Matrix<double, dim, n_particle_dofs<dim>> opening_rows(const Vector<dim> &lever, double sign)
{
  Eigen::Matrix<double, dim, n_particle_dofs<dim>> rows;
  rows.template leftCols<dim>().setIdentity();
  rows.template rightCols<n_spins<dim>>() = tip_rows(lever);
  return sign * rows;
}

/// Twist and bending are these rows times the difference of the rotation vectors.
inline Eigen::Matrix<double, 1, 1> bending_rows(const Bond<2> &)
{
  return Spin<2>(1.);
}
inline Eigen::Matrix<double, 3, 3> bending_rows(const Bond<3> &b)
{
  const Vector<3> t = b.normal.unitOrthogonal();
  Eigen::Matrix<double, 3, 3> m;
  m << b.normal.transpose(), t.transpose(), b.normal.cross(t).transpose();
  return m;
}
/// And resisted by these, N m.
inline Spin<2> bending_stiffness(const Bond<2> &b)
{
  return Spin<2>(b.bending);
}
inline Spin<3> bending_stiffness(const Bond<3> &b)
{
  return {b.twist, b.bending, b.bending};
}
} // namespace ligament::dem
