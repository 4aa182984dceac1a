// Griffith's load of cracks in crystals: closed forms, and an integral that knows no roots.
#include "md/griffith.h"

#include "core/check.h"
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

/// Stress in Pa at a place, from differences of the field over a thousandth of its distance.
Strain<3> stress_of(const CrackField &field, const Stiffness<3> &c, const Vector<2> &place)
{
  const double step = 1e-3 * place.norm();
  Eigen::Matrix2d h;
  for (int j = 0; j < 2; ++j) {
    const Vector<2> way = step * Vector<2>::Unit(j);
    h.col(j) = (field.displacement(place + way) - field.displacement(place - way)) / (2 * step);
  }
  Strain<3> strain = Strain<3>::Zero();
  strain[0] = h(0, 0);
  strain[1] = h(1, 1);
  strain[voigt_index<3>(0, 1)] = h(0, 1) + h(1, 0);
  return c * strain;
}

TEST(Griffith, FieldOpensAsItsModulusSays)
{
  const auto iron = crystal("Fe", CrystalKind::bcc, orientation_of({0, 1, -1}, {1, 0, 0})),
             copper = crystal("Cu", CrystalKind::fcc, orientation_of({1, 1, -2}, {1, 1, 1}));
  const double r = 3e-9;
  for (const Stiffness<3> &c : {iron.elastic_constants().stiffness,
                                copper.elastic_constants().stiffness, isotropic(1.3e11, 0.8e11)})
  {
    const CrackField field(c);
    // Irwin: G = K^2/E' asks for an opening of 8 K/E' sqrt(r/2 pi). Coinciding roots were parted
    // by a thousandth: the mean of both stays, the error is its square.
    const double opening = field.displacement({-r, 0.0})[1] - field.displacement({-r, -0.0})[1];
    EXPECT_NEAR(opening * *crack_modulus(c) / (8 * std::sqrt(r / (2 * M_PI))), 1, 2e-6);
    // What K means; differences over s leave s^2 times 5/8 or so.
    const double ahead = 1 / std::sqrt(2 * M_PI * r);
    const Strain<3> before = stress_of(field, c, {r, 0}),
                    flank = stress_of(field, c, {-r, 2e-3 * r});
    EXPECT_NEAR(before[1] / ahead, 1, 5e-6);
    EXPECT_NEAR(before[voigt_index<3>(0, 1)] / ahead, 0, 5e-6);
    // Without traction on the faces, from which the place is 0.002 r away: its traction grows
    // with that distance over r, by a factor of about one.
    EXPECT_NEAR(flank[1] / ahead, 0, 0.01);
    EXPECT_NEAR(flank[voigt_index<3>(0, 1)] / ahead, 0, 0.01);
  }
}

TEST(Griffith, OfNoFrontAcrossWhichNothingIsMirrored)
{
  const auto skew = crystal("Cu", CrystalKind::fcc, orientation_of({1, 2, 3}, {-2, 1, 0}));
  EXPECT_FALSE(crack_modulus(skew.elastic_constants().stiffness));
  EXPECT_FALSE(griffith_crack(skew, {0, 1, 0}, {0, 0, 1}));
  EXPECT_THROW(CrackField(skew.elastic_constants().stiffness), core::InputError);
}
} // namespace ligament::md::testing
