// Griffith's load of cracks in crystals: closed forms, and an integral that knows no roots.
#include "md/griffith.h"

#include "md/analytic.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>

namespace ligament::md::testing
{
Stiffness<3> isotropic(double lambda, double mu)
{
  Stiffness<3> c = Stiffness<3>::Zero();
  c.topLeftCorner<3, 3>().setConstant(lambda);
  for (int k = 0; k < 3; ++k) {
    c(k, k) += 2 * mu;
    c(k + 3, k + 3) = mu;
  }
  return c;
}

/// a_j C_ijkl b_l.
Matrix<3> contracted(const Stiffness<3> &c, const Vector<3> &a, const Vector<3> &b)
{
  Matrix<3> m = Matrix<3>::Zero();
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j)
        for (int l = 0; l < 3; ++l)
          m(i, k) += a[j] * c(voigt_index<3>(i, j), voigt_index<3>(k, l)) * b[l];
  return m;
}

/// E' from the tensor L of D. M. Barnett and J. Lothe (Phys. Norv. 7 (1973) 13): G = 1/2 K . L^-1 K
/// with L = 1/pi int (mm) - (mn) (nn)^-1 (nm), m and n turning about the front. The sum over equal
/// angles is exact to rounding.
double modulus_by_angles(const Stiffness<3> &c)
{
  Matrix<3> l = Matrix<3>::Zero();
  constexpr int n_angles = 400;
  for (int k = 0; k < n_angles; ++k) {
    const double angle = M_PI * k / n_angles;
    const Vector<3> m(std::cos(angle), std::sin(angle), 0), n(-m[1], m[0], 0);
    const Matrix<3> mn = contracted(c, m, n);
    l += (contracted(c, m, m) - mn * contracted(c, n, n).inverse() * mn.transpose()) / n_angles;
  }
  return 2 / l.inverse()(1, 1);
}

Crystal<3> crystal(const std::string &metal, CrystalKind kind, const Matrix<3> &orientation)
{
  CrystalParameters<3> p;
  p.kind = kind;
  p.orientation = orientation;
  return {zhou_johnson_wadley({metal}), p};
}

TEST(Griffith, OfIsotropicBodies)
{
  const double lambda = 1.3, mu = 0.8, nu = lambda / (2 * (lambda + mu));
  // The roots coincide, and are known to half of the digits.
  EXPECT_NEAR(*crack_modulus(isotropic(lambda, mu)) * (1 - nu) / (2 * mu), 1, 1e-7);
}

TEST(Griffith, OfOrthotropicBodies)
{
  const auto iron = crystal("Fe", CrystalKind::bcc, Matrix<3>::Identity());
  const Stiffness<3> c = iron.elastic_constants().stiffness, s = c.inverse();
  const double b11 = s(0, 0) - s(0, 2) * s(0, 2) / s(2, 2),
               b12 = s(0, 1) - s(0, 2) * s(1, 2) / s(2, 2);
  // Sih, Paris and Irwin's case of axes along the crack, with b22 = b11.
  const double expected = M_SQRT2 / (b11 * std::sqrt(1 + (2 * b12 + s(5, 5)) / (2 * b11)));
  EXPECT_NEAR(*crack_modulus(c) / expected, 1, 1e-12);
  EXPECT_NEAR(modulus_by_angles(c) / expected, 1, 1e-12);
  const auto crack = griffith_crack(iron, {0, 1, 0}, {0, 0, 1}).value();
  EXPECT_NEAR(crack.modulus / expected, 1, 1e-12);
  EXPECT_NEAR(crack.stress_intensity, std::sqrt(2 * expected * iron.surface_energy({0, 1, 0})),
              1e-6);
}

TEST(Griffith, OfTurnedCrystals)
{
  const auto copper = crystal("Cu", CrystalKind::fcc, orientation_of({1, 1, -2}, {1, 1, 1}));
  const Stiffness<3> c = copper.elastic_constants().stiffness;
  ASSERT_GT(std::abs(c(0, 5)), 0.05 * c(0, 0)); // shear and stretch do not part
  EXPECT_NEAR(*crack_modulus(c) / modulus_by_angles(c), 1, 1e-12);

  // The same crack wherever the crystal lies in space.
  const Matrix<3> turn = orientation_of({1, 2, 3}, {-2, 1, 0});
  const auto elsewhere = crystal("Cu", CrystalKind::fcc, turn * copper.parameters().orientation);
  const auto a = griffith_crack(copper, {0, 1, 0}, {0, 0, 1}).value(),
             b = griffith_crack(elsewhere, turn.col(1), turn.col(2)).value();
  EXPECT_NEAR(b.modulus / a.modulus, 1, 1e-10);
  EXPECT_NEAR(b.surface_energy / a.surface_energy, 1, 1e-10);
  EXPECT_NEAR(a.surface_energy / copper.surface_energy({1, 1, 1}), 1, 1e-12);
}

TEST(Griffith, OfNoFrontAcrossWhichNothingIsMirrored)
{
  const auto skew = crystal("Cu", CrystalKind::fcc, orientation_of({1, 2, 3}, {-2, 1, 0}));
  EXPECT_FALSE(crack_modulus(skew.elastic_constants().stiffness));
  EXPECT_FALSE(griffith_crack(skew, {0, 1, 0}, {0, 0, 1}));
}
} // namespace ligament::md::testing
