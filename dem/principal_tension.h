// The tension of a face as seen along the largest principal stress, theory.md eq. (D12), and what
// bounds it.
#pragma once

#include "core/types.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace ligament::dem
{
template <int dim>
struct PrincipalTension
{
  /// |n.e1| of faces that are asked, theory.md eq. (D12).
  static constexpr double cone = dim == 2 ? 0.577 : 0.4;
  /// tan of that inclination: no tension is above sigma + tangent |tau|.
  static constexpr double tangent = dim == 2 ? 1.4156 : 2.2913;

  /// S_0 of eq. (D12b) in m^2, of unit thickness in 2D: the face of the densest lattice.
  static double whole_face(double spacing)
  {
    return dim == 2 ? spacing / std::sqrt(3.) : spacing * spacing / std::sqrt(8.);
  }

  /// What no tension is above that a traction on a face with this normal has along the largest
  /// principal stress of a tensor (Voigt order), eq. (D12d).
  /// Of faces with |n.e1| of at least `least`.
  static double bound(const Strain<dim> &s, const Vector<dim> &normal, const Vector<dim> &traction,
                      double least = cone)
  {
    double largest;
    Vector<dim> own;
    if constexpr (dim == 2) {
      largest = (s[0] + s[1]) / 2 + std::hypot((s[0] - s[1]) / 2, s[2]);
      own = {s[0] * normal[0] + s[2] * normal[1], s[2] * normal[0] + s[1] * normal[1]};
    } else {
      const double mean = (s[0] + s[1] + s[2]) / 3;
      const Vector<3> deviator = s.template head<3>().array() - mean, off = s.template tail<3>();
      largest = mean + std::sqrt(2. / 3 * (deviator.squaredNorm() + 2 * off.squaredNorm()));
      own = {s[0] * normal[0] + s[5] * normal[1] + s[4] * normal[2],
             s[5] * normal[0] + s[1] * normal[1] + s[3] * normal[2],
             s[4] * normal[0] + s[3] * normal[1] + s[2] * normal[2]};
    }
    return largest + (traction - own).norm() / least;
  }

  /// Direction of the largest principal stress (Voigt order), unit.
  static Vector<dim> direction(const Strain<dim> &s)
  {
    if constexpr (dim == 2) {
      const double angle = 0.5 * std::atan2(2 * s[2], s[0] - s[1]);
      return {std::cos(angle), std::sin(angle)};
    } else {
      Eigen::Matrix3d m;
      m << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
      return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m).eigenvectors().col(2);
    }
  }
};
} // namespace ligament::dem
