// A closed crack with open wings under compression in an infinite plate, by displacement
// discontinuities: what wing cracks of particles are compared with.
#pragma once

namespace ligament::program
{
struct KinkedCrack
{
  double half_length, wing; // m, of the crack and of each wing
  double inclination;       // rad, of the crack against the normal of the pressure
  double kink;              // rad, of the wings against the crack
  double friction, poissons_ratio;
};

/// K_I in Pa m^0.5 at the end of a wing, per Pa of uniaxial pressure. Elements of constant
/// displacement discontinuity (Crouch and Starfield); the factor of the one at the end comes from a
/// straight crack under tension, of the same elements and twice the wing's length.
double stress_intensity(const KinkedCrack &crack);

/// The largest over all kinks away from the crack.
double largest_stress_intensity(KinkedCrack crack);
} // namespace ligament::program
