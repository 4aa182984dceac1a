// The strength factor of the crack tip against published values and its own invariances.
#include "dem/toughness_calibration.h"

#include <gtest/gtest.h>

namespace ligament::dem::testing
{
using Kind = particles::LatticeKind;

DemMaterial material(double nu, PlaneMode plane = PlaneMode::strain)
{
  return {7e10, nu, 2500, plane, 0};
}

TEST(ToughnessCalibration, KnownFactorsAlongARow)
{
  // By theory.md section 1.6: 0.75 for the square lattice, 0.81 to 0.83 for the hexagonal one.
  EXPECT_NEAR(calibrate_toughness<2>(Kind::square, Spin<2>(0.), material(0.22)), 0.75, 0.01);
  for (const PlaneMode plane : {PlaneMode::strain, PlaneMode::stress}) {
    const double c = calibrate_toughness<2>(Kind::hexagonal, Spin<2>(0.), material(0.22, plane));
    EXPECT_GT(c, 0.805);
    EXPECT_LT(c, 0.835);
  }
}

TEST(ToughnessCalibration, TurnedLatticeAndTurnedCrackAreTheSame)
{
  CrackAxes<2> crack;
  crack.growth = {std::cos(0.4), std::sin(0.4)};
  crack.normal = {-std::sin(0.4), std::cos(0.4)};
  EXPECT_NEAR(calibrate_toughness<2>(Kind::hexagonal, Spin<2>(0.4), material(0.3), crack),
              calibrate_toughness<2>(Kind::hexagonal, Spin<2>(0.), material(0.3)), 1e-9);
}

TEST(ToughnessCalibration, ModulusAndDensityDontMatterThePatchSizeHardly)
{
  DemMaterial other = material(0.22);
  other.youngs_modulus = 3, other.density = 1;
  EXPECT_DOUBLE_EQ(calibrate_toughness<2>(Kind::hexagonal, Spin<2>(0.), other),
                   calibrate_toughness<2>(Kind::hexagonal, Spin<2>(0.), material(0.22)));
  const auto at = [](double radius) {
    return crack_tip_factor<2>(Kind::hexagonal, Spin<2>(0.), material(0.22), {}, {0.1, 0.}, radius);
  };
  EXPECT_NEAR(at(15), at(30), 3e-3);
}

TEST(ToughnessCalibration, SimpleCubicSlabIsTheSquareLatticeInPlaneStrain)
{
  // The same network but for the bending stiffness of a square instead of a rectangle.
  const double slab =
      crack_tip_factor<3>(Kind::simple_cubic, Spin<3>::Zero(), material(0.2), {}, {0.1, 0.}, 8);
  const double plane =
      crack_tip_factor<2>(Kind::square, Spin<2>(0.), material(0.2), {}, {0.1, 0.}, 8);
  EXPECT_NEAR(slab, plane, 0.02);
}
} // namespace ligament::dem::testing
