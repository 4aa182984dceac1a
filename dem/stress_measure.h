// How much of its strength a stress takes, as a convex number: what the tensor criteria have in
// common and the kernels know of them.
#pragma once

#include "core/types.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace ligament::dem
{
/// theory.md eq. (D12e): the larger one of
///   largest s_1 - opposite s_n + sqrt(square s:s + trace_square tr^2) + trace tr   and   cut s_1
/// with s_1 the largest and s_n the smallest principal stress in the plane (2D) or in space. Convex
/// where largest, opposite, cut and the root are, grows with the stress as its factor does.
struct StressMeasure
{
  double largest = 1, opposite = 0, square = 0, trace_square = 0, trace = 0, cut = 0;
  /// Times |t - S n| it is at least what the face's own traction t adds to the value of S.
  double residual = 0;
  /// Instead, of maximum tension, the right side of eq. (D12d), which knows the sides.
  bool sided = true;

  /// With the bound for tensors that have the face's own traction in place of theirs, eq. (D12f).
  static StressMeasure with_own_traction(StressMeasure m)
  {
    const double eigenvalue = 2 / std::sqrt(3.); // no principal value of the difference is above
    const double root = std::sqrt(std::max({2 * m.square, m.square + m.trace_square, 0.}));
    m.residual = std::max(eigenvalue * (m.largest + m.opposite) + root + std::abs(m.trace),
                          eigenvalue * m.cut);
    m.sided = false;
    return m;
  }

  /// The same in other units.
  StressMeasure times(double factor) const
  {
    return {largest * factor,         opposite * factor,
            square * factor * factor, trace_square * factor * factor,
            trace * factor,           cut * factor,
            residual * factor,        sided};
  }

  friend bool operator==(const StressMeasure &a, const StressMeasure &b)
  {
    return a.largest == b.largest && a.opposite == b.opposite && a.square == b.square &&
           a.trace_square == b.trace_square && a.trace == b.trace && a.cut == b.cut &&
           a.residual == b.residual && a.sided == b.sided;
  }
};

/// Smallest and largest principal stress in Pa of a tensor in Voigt order.
template <int dim>
struct PrincipalRange
{
  double smallest, largest;

  explicit PrincipalRange(const Strain<dim> &s)
  {
    if constexpr (dim == 2) {
      const double mean = (s[0] + s[1]) / 2, radius = std::hypot((s[0] - s[1]) / 2, s[2]);
      smallest = mean - radius;
      largest = mean + radius;
    } else {
      Eigen::Matrix3d m;
      m << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
      const Eigen::Vector3d values =
          Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m, Eigen::EigenvaluesOnly).eigenvalues();
      smallest = values[0];
      largest = values[2];
    }
  }
};

/// In Pa, of a tensor in Voigt order.
template <int dim>
double value_of(const StressMeasure &m, const Strain<dim> &s, const PrincipalRange<dim> &range)
{
  const double trace = s.template head<dim>().sum();
  const double square =
      s.template head<dim>().squaredNorm() + 2 * s.tail(n_strains<dim> - dim).squaredNorm();
  const double root = std::sqrt(std::max(m.square * square + m.trace_square * trace * trace, 0.));
  return std::max(m.largest * range.largest - m.opposite * range.smallest + root + m.trace * trace,
                  m.cut * range.largest);
}
} // namespace ligament::dem
