// A closed crack with open wings under compression, by displacement discontinuities: what wing
// cracks of particles are compared with.
#pragma once

#include <Eigen/Core>

namespace ligament::program
{
struct KinkedCrack
{
  double half_length, wing; // m, of the crack and of each wing
  double inclination;       // rad, of the crack against the normal of the pressure
  double kink;              // rad, of the wings against the crack
  double friction, poissons_ratio;
  Eigen::Vector2d plate = {0, 0}; // m, about the crack's middle, pressed along y; 0: infinite
};

/// K_I in Pa m^0.5 at the end of a wing, per Pa of uniaxial pressure. Elements of constant
/// displacement discontinuity (Crouch and Starfield); the factor of the one at the end comes from a
/// straight crack under tension, of the same elements and twice the wing's length. The limit of
/// elements whose number doubles: against known cracks good to 0.1 %, short kinks to 2 %.
double stress_intensity(const KinkedCrack &crack);

/// K_I of a straight crack across a plate under tension over that in an infinite one.
double straight_crack_in_plate(double half_length, const Eigen::Vector2d &plate);

/// The largest over kinks of 45 to 85 degrees towards the pressure, in steps of 5.
double largest_stress_intensity(KinkedCrack crack);
} // namespace ligament::program
