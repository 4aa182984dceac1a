// Displacements around a hole in an endless plate under tension.
#pragma once

#include "core/types.h"

#include <complex>

namespace ligament::program
{
/// Endless plate in plane strain, hole of radius R at the origin, stress 1 along x far away
/// (Kirsch 1898, in Kolosov's form).
struct KirschField
{
  double radius, shear_modulus, poissons_ratio;

  /// Displacement and rotation.
  Vector<3> operator()(const Vector<2> &x) const
  {
    const std::complex<double> z(x[0], x[1]);
    const double r2 = radius * radius, kappa = 3 - 4 * poissons_ratio;
    const auto phi = (z + 2 * r2 / z) / 4., slope = (1. - 2 * r2 / (z * z)) / 4.;
    const auto psi = -(z + r2 / z - r2 * r2 / (z * z * z)) / 2.;
    const auto u = (kappa * phi - z * std::conj(slope) - std::conj(psi)) / (2 * shear_modulus);
    return {u.real(), u.imag(), (kappa + 1) / (2 * shear_modulus) * slope.imag()};
  }
};
} // namespace ligament::program
