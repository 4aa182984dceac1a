#include "md/griffith.h"

#include "core/check.h"

#include <Eigen/Dense>

#include <cmath>
#include <complex>

namespace ligament::md
{
namespace
{
/// The two roots with a positive imaginary part of b11 m^4 - 2 b16 m^3 + (2 b12 + b66) m^2 - 2 b26
/// m
/// + b22 as eigenvalues of its companion matrix; b: compliance in plane strain.
std::array<std::complex<double>, 2> upper_roots(const Eigen::Matrix3d &b)
{
  Eigen::Matrix4d companion = Eigen::Matrix4d::Zero();
  companion.bottomLeftCorner<3, 3>().setIdentity();
  companion.col(3) << -b(1, 1), 2 * b(1, 2), -(2 * b(0, 1) + b(2, 2)), 2 * b(0, 2);
  companion.col(3) /= b(0, 0);
  const Eigen::Vector4cd roots = companion.eigenvalues();
  std::array<std::complex<double>, 2> upper;
  int n = 0;
  for (const auto &root : roots)
    if (root.imag() > 0 && n < 2)
      upper[n++] = root;
  core::require(n == 2, "an elastic body is not stable: its crack has no field");
  return upper;
}

/// The compliance within the plane without strain along z, which is the inverse of C there; empty
/// where planes across z are no mirrors.
std::optional<Eigen::Matrix3d> plane_compliance(const Stiffness<3> &c)
{
  constexpr std::array across = {voigt_index<3>(1, 2), voigt_index<3>(0, 2)};
  constexpr std::array within = {0, 1, voigt_index<3>(0, 1)};
  for (const int k : {0, 1, 2, within[2]})
    for (const int a : across)
      if (std::abs(c(k, a)) > 1e-9 * c(0, 0))
        return {};
  Eigen::Matrix3d plane;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      plane(i, j) = c(within[i], within[j]);
  return plane.inverse();
}
} // namespace

std::optional<double> crack_modulus(const Stiffness<3> &c)
{
  const auto b = plane_compliance(c);
  if (!b)
    return {};
  const auto roots = upper_roots(*b);
  return -2 / ((*b)(1, 1) * ((roots[0] + roots[1]) / (roots[0] * roots[1])).imag());
}

CrackField::CrackField(const Stiffness<3> &c)
{
  const auto plane = plane_compliance(c);
  core::require(plane.has_value(), "planes across the front of a crack are no mirrors");
  const Eigen::Matrix3d &b = *plane;
  roots_ = upper_roots(b);
  if (std::abs(roots_[0] - roots_[1]) < 1e-3 * std::abs(roots_[0])) {
    roots_[0] *= 1.001;
    roots_[1] *= 0.999;
  }
  for (int k = 0; k < 2; ++k) {
    const auto m = roots_[k];
    const Eigen::Vector2cd pq(b(0, 0) * m * m + b(0, 1) - b(0, 2) * m,
                              b(0, 1) * m + b(1, 1) / m - b(1, 2));
    // The other root's share makes the faces free of traction and sigma_yy ahead real.
    columns_[k] = (k == 0 ? -roots_[1] : roots_[0]) / (roots_[0] - roots_[1]) * pq;
  }
}

Vector<2> CrackField::displacement(const Vector<2> &place) const
{
  const double r = place.norm(), angle = std::atan2(place[1], place[0]);
  Vector<2> u = Vector<2>::Zero();
  for (int k = 0; k < 2; ++k)
    u += (columns_[k] * std::sqrt(std::cos(angle) + roots_[k] * std::sin(angle))).real();
  return std::sqrt(2 * r / M_PI) * u;
}

std::optional<GriffithCrack> griffith_crack(const Crystal<3> &crystal, const Vector<3> &normal,
                                            const Vector<3> &front)
{
  auto parameters = crystal.parameters();
  Matrix<3> axes; // rows: what becomes x, y, z
  axes << normal.cross(front).transpose(), normal.transpose(), front.transpose();
  const Vector<3> plane = parameters.orientation.transpose() * normal;
  parameters.orientation = axes * parameters.orientation;
  const Crystal<3> turned(crystal.potential(), parameters);
  const auto modulus = crack_modulus(turned.elastic_constants().stiffness);
  if (!modulus)
    return {};
  GriffithCrack crack;
  crack.modulus = *modulus;
  crack.surface_energy = crystal.surface_energy(plane);
  crack.stress_intensity = std::sqrt(2 * crack.surface_energy * crack.modulus);
  return crack;
}
} // namespace ligament::md
