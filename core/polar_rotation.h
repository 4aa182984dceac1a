// The rotation that a deformation gradient contains, and how it turns with the gradient.
#pragma once

#include "core/types.h"

#include <Eigen/LU>

#include <cmath>

#include <Eigen/Geometry>

namespace ligament::core
{
/// y x g; in 2D y is the component out of the plane.
inline Vector<2> spin_cross(const Spin<2> &y, const Vector<2> &g)
{
  return {-y[0] * g[1], y[0] * g[0]};
}
inline Vector<3> spin_cross(const Spin<3> &y, const Vector<3> &g)
{
  return y.cross(g);
}

/// a x b; in 2D the component out of the plane.
inline Spin<2> moment(const Vector<2> &a, const Vector<2> &b)
{
  return Spin<2>(a[0] * b[1] - a[1] * b[0]);
}
inline Spin<3> moment(const Vector<3> &a, const Vector<3> &b)
{
  return a.cross(b);
}

/// F = R S, S symmetric and positive (theory.md, "Large rotation"). When F changes at the rate
/// sum_a v_a g_a^T, R turns with the spin sum_a spin_block(g_a) v_a.
template <int dim>
class PolarRotation
{
public:
  using Matrix = Eigen::Matrix<double, dim, dim>;

  /// F must not be singular.
  explicit PolarRotation(const Matrix &f);

  const Matrix &matrix() const { return r_; }

  /// rad, in [0, pi].
  double angle() const
  {
    if constexpr (dim == 2)
      return std::abs(std::atan2(r_(1, 0), r_(0, 0)));
    else
      return std::atan2(
          Vector<3>(r_(2, 1) - r_(1, 2), r_(0, 2) - r_(2, 0), r_(1, 0) - r_(0, 1)).norm(),
          r_.trace() - 1);
  }

  /// A torque T in axes of the rotated body becomes the forces R (y x g_a), y = (tr S - S)^-1 T: so
  /// that both do the same work.
  Spin<dim> conjugate(const Spin<dim> &body_torque) const { return inverse_ * body_torque; }

  /// Force on the node with gradient g by y = conjugate(T), in space axes.
  Vector<dim> force(const Spin<dim> &y, const Vector<dim> &g) const
  {
    return r_ * spin_cross(y, g);
  }

  /// Spin in space axes that a unit velocity of the node with gradient g gives R.
  Eigen::Matrix<double, n_spins<dim>, dim> spin_block(const Vector<dim> &g) const;

  /// A torque or spin in space axes, in those of the rotated body.
  Spin<dim> to_body(const Spin<dim> &t) const
  {
    if constexpr (dim == 2)
      return t;
    else
      return r_.transpose() * t;
  }

private:
  Matrix r_;
  Eigen::Matrix<double, n_spins<dim>, n_spins<dim>> inverse_; // (tr S - S)^-1
};

template <>
inline PolarRotation<2>::PolarRotation(const Matrix &f)
{
  const double c = f(0, 0) + f(1, 1), s = f(1, 0) - f(0, 1), trace = std::sqrt(c * c + s * s);
  r_ << c / trace, -s / trace, s / trace, c / trace;
  inverse_(0, 0) = 1 / trace;
}

// Newton's iteration for the polar decomposition (N. Higham, SIAM J. Sci. Stat. Comput. 7 (1986)
// 1160): quadratic, four to five rounds at strains of a few percent.
template <>
inline PolarRotation<3>::PolarRotation(const Matrix &f) : r_(f)
{
  for (int round = 0; round < 30; ++round) {
    const Matrix next = 0.5 * (r_ + r_.inverse().transpose());
    const double change = (next - r_).squaredNorm();
    r_ = next;
    if (change < 1e-20) // the next round would change the square of that
      break;
  }
  const Matrix rtf = r_.transpose() * f;
  const Matrix s = 0.5 * (rtf + rtf.transpose());
  inverse_ = (s.trace() * Matrix::Identity() - s).inverse();
}

template <int dim>
Eigen::Matrix<double, n_spins<dim>, dim> PolarRotation<dim>::spin_block(const Vector<dim> &g) const
{
  if constexpr (dim == 2)
    return inverse_(0, 0) * Eigen::RowVector2d(-g[1], g[0]) * r_.transpose();
  else {
    Matrix cross;
    cross << 0, -g[2], g[1], g[2], 0, -g[0], -g[1], g[0], 0;
    return r_ * inverse_ * cross * r_.transpose();
  }
}
} // namespace ligament::core
