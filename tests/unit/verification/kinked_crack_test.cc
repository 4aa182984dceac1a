// The reference of wing cracks against what is known of straight and of barely kinked cracks.
#include "src/verification/bodies/kinked_crack.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace ligament::program;

namespace
{
// Tada's formula for a crack across a plate under tension, good to 0.1 %.
TEST(KinkedCrack, StraightOneInAPlateOfFiniteWidth)
{
  for (const double width : {3., 4., 6., 20.}) {
    const double share = 2 / width;
    const double tada = std::sqrt(1 / std::cos(M_PI / 2 * share)) *
                        (1 - 0.025 * std::pow(share, 2) + 0.06 * std::pow(share, 4));
    EXPECT_NEAR(straight_crack_in_plate(1, {width, 3 * width}), tada, 5e-3 * tada) << width;
  }
}

// A short kink off a crack under pure shear K_II: the largest K_I is 1.22 K_II, at 77 degrees
// (Amestoy and Leblond 1992); with the length it changes as its root at first. Pressed at 45
// degrees a closed crack has K_II = (1 - mu)/2 sqrt(pi a).
TEST(KinkedCrack, ShortKinkOfAClosedCrack)
{
  for (const double friction : {0., 0.3}) {
    KinkedCrack crack = {1, 2.5e-4, M_PI / 4, 77 * M_PI / 180, friction, 0.25};
    const double shear = (1 - friction) / 2 * std::sqrt(M_PI);
    const double quarter = stress_intensity(crack);
    crack.wing *= 4;
    const double whole = stress_intensity(crack);
    EXPECT_NEAR((2 * quarter - whole) / shear, 1.22, 0.03);
    for (const double degrees : {62., 92.}) {
      crack.kink = degrees * M_PI / 180;
      EXPECT_LT(stress_intensity(crack), whole);
    }
  }
}

// Of a large plate as without sides; a narrow one is weaker.
TEST(KinkedCrack, WingsNearFreeSides)
{
  KinkedCrack crack = {1, 0.1, M_PI / 4, M_PI / 180 * 67, 0.3, 0.25};
  const double infinite = stress_intensity(crack);
  crack.plate = {60, 60};
  EXPECT_NEAR(stress_intensity(crack), infinite, 3e-3 * infinite);
  crack.plate = {6, 16};
  EXPECT_GT(stress_intensity(crack), 1.05 * infinite);
}
} // namespace
