// When faces that touch grow together again, and what holds them then.
#pragma once

#include <algorithm>
#include <cmath>

namespace ligament::dem
{
/// Of the particles of one material, theory.md section 1.14. A contact becomes a bond where both
/// sides allow it.
struct Rebonding
{
  double pressure = 0;       // Pa, least one on the face
  double plastic_strain = 0; // least accumulated one of the particle
  double strength = 0;       // Pa, of adhesion; 0: never

  bool is_on() const { return strength > 0; }

  /// Between two materials: the larger pressure, the smaller strength; strains are asked on either
  /// side.
  friend Rebonding between(const Rebonding &a, const Rebonding &b)
  {
    return {std::max(a.pressure, b.pressure), 0, std::min(a.strength, b.strength)};
  }
};

/// How near to its end adhesion is: under tension by all of the traction, under pressure by the
/// shear that friction does not hold. Pa; 1: it breaks.
inline double adhesion_utilisation(double normal, double shear, double strength, double friction)
{
  return normal >= 0 ? std::hypot(normal, shear) / strength
                     : shear / (strength - friction * normal);
}
} // namespace ligament::dem
