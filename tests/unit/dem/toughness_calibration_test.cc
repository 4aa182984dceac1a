// The strength factor of the crack tip against published values and its own invariances.
#include "dem/toughness_calibration.h"

#include <gtest/gtest.h>

namespace ligament::dem::testing
{
using Kind = packings::LatticeKind;
constexpr auto face_tension = FractureLaw::Criterion::face_tension,
               principal = FractureLaw::Criterion::maximum_tension;

DemMaterial material(double nu, PlaneMode plane = PlaneMode::strain)
{
  return {7e10, nu, 2500, plane, 0};
}

TEST(ToughnessCalibration, KnownFactorsAlongARow)
{
  const auto factor = [](Kind kind, PlaneMode plane) {
    return crack_tip_factor<2>(kind, Spin<2>(0.), material(0.22, plane), face_tension, {},
                               {{0.1, 0}, 30});
  };
  // By theory.md section 1.6: 0.75 for the square lattice, 0.81 to 0.83 for the hexagonal one.
  EXPECT_NEAR(factor(Kind::square, PlaneMode::strain), 0.75, 0.01);
  for (const PlaneMode plane : {PlaneMode::strain, PlaneMode::stress}) {
    EXPECT_GT(factor(Kind::hexagonal, plane), 0.805);
    EXPECT_LT(factor(Kind::hexagonal, plane), 0.835);
  }
}

TEST(ToughnessCalibration, TurnedLatticeAndTurnedCrackAreTheSame)
{
  CrackAxes<2> crack;
  crack.growth = {std::cos(0.4), std::sin(0.4)};
  crack.normal = {-std::sin(0.4), std::cos(0.4)};
  EXPECT_NEAR(
      calibrate_toughness<2>(Kind::hexagonal, Spin<2>(0.4), material(0.3), principal, crack),
      calibrate_toughness<2>(Kind::hexagonal, Spin<2>(0.), material(0.3), principal), 1e-9);
}

// The centre of a body lies on a bond of its hexagonal lattice: 60 degrees less the angle has the
// mirror image, the angle with a minus has its lattice at another place.
TEST(ToughnessCalibration, MirrorImagesAreAsTough)
{
  const double angle = 0.35;
  EXPECT_NEAR(
      calibrate_toughness<2>(Kind::hexagonal, Spin<2>(angle), material(0.3), principal),
      calibrate_toughness<2>(Kind::hexagonal, Spin<2>(M_PI / 3 - angle), material(0.3), principal),
      1e-9);
}

TEST(ToughnessCalibration, ModulusAndDensityDontMatterThePatchSizeHardly)
{
  DemMaterial other = material(0.22);
  other.youngs_modulus = 3, other.density = 1;
  const auto at = [](double radius, const DemMaterial &glass) {
    return crack_tip_factor<2>(Kind::hexagonal, Spin<2>(0.), glass, principal, {},
                               {{0.1, 0}, radius});
  };
  EXPECT_DOUBLE_EQ(at(15, other), at(15, material(0.22)));
  EXPECT_NEAR(at(15, other), at(30, other), 3e-3);
}

// Every row of an aligned crack is like the last: where it runs it needs what it needs to start.
TEST(ToughnessCalibration, AlignedCracksRunAsTheyStart)
{
  for (const Kind kind : {Kind::hexagonal, Kind::square}) {
    CrackPatch patch;
    patch.t_stress = -1 / std::sqrt(M_PI * 40); // theory.md section 1.6
    const double first =
        crack_tip_factor<2>(kind, Spin<2>(0.), material(0.22), principal, {}, patch);
    EXPECT_NEAR(calibrate_toughness<2>(kind, Spin<2>(0.), material(0.22), principal), first, 3e-3);
  }
}

TEST(ToughnessCalibration, SimpleCubicSlabIsTheSquareLatticeInPlaneStrain)
{
  // The same network but for the bending stiffness of a square instead of a rectangle.
  const CrackPatch patch{{0.1, 0}, 8, 2 * std::sqrt(2.)};
  const double slab = crack_tip_factor<3>(Kind::simple_cubic, Spin<3>::Zero(), material(0.2),
                                          face_tension, {}, patch);
  const double plane =
      crack_tip_factor<2>(Kind::square, Spin<2>(0.), material(0.2), face_tension, {}, patch);
  EXPECT_NEAR(slab, plane, 0.02);
}

// A strip in plane strain against the near field of the plane packing: the stress along the crack
// and the terms of the field that they share with no other are worth some per cent.
TEST(ToughnessCalibration, AFrontInSimpleCubicLayersIsASquareLatticesTip)
{
  const double front =
      calibrate_toughness<3>(Kind::simple_cubic, Spin<3>::Zero(), material(0.22), face_tension);
  const double tip =
      calibrate_toughness<2>(Kind::square, Spin<2>(0.), material(0.22), face_tension);
  EXPECT_NEAR(front, tip, 0.05 * tip);
}

// No packing's toughness is far from another's: 2D packings of faces of like size.
TEST(ToughnessCalibration, PackingsAreAlike)
{
  const double along_a_row =
      calibrate_toughness<2>(Kind::hexagonal, Spin<2>(0.), material(0.22), principal);
  EXPECT_NEAR(calibrate_toughness<2>(Kind::hexagonal, Spin<2>(0.26), material(0.22), principal),
              along_a_row, 0.03 * along_a_row);
  packings::RandomParameters<2> packing;
  packing.relaxation_sweeps = 10;
  const double random = calibrate_toughness<2>(packing, material(0.22), principal);
  EXPECT_NEAR(random, along_a_row, 0.03 * along_a_row);
  packing.seed = 17;
  EXPECT_EQ(calibrate_toughness<2>(packing, material(0.22), principal), random);
}
} // namespace ligament::dem::testing
