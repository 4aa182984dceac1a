// What a crack in a crystal needs at least: Griffith's stress intensity, theory.md (M13), (M14).
#pragma once

#include "md/crystal.h"

#include <array>
#include <complex>
#include <optional>

namespace ligament::md
{
/// E' in Pa of a straight crack under mode I in plane strain, G = K_I^2 / E'; the crack runs along
/// x, across y, its front along z. C in Pa, of any symmetry in which planes across z are mirrors;
/// empty where they are none.
std::optional<double> crack_modulus(const Stiffness<3> &c);

/// Displacements near the front of such a crack, which lies at x < 0, y = 0: (M15).
class CrackField
{
public:
  /// C in Pa; throws core::InputError where planes across z are no mirrors. Roots of (M14) that
  /// coincide, as those of isotropic bodies do, are taken apart by a thousandth.
  explicit CrackField(const Stiffness<3> &c);

  /// u_x and u_y in m at a place in m from the front, for K_I = 1 Pa sqrt(m).
  Vector<2> displacement(const Vector<2> &place) const;

private:
  std::array<std::complex<double>, 2> roots_;
  std::array<Eigen::Vector2cd, 2> columns_; // 1/Pa, of the two roots
};

struct GriffithCrack
{
  double modulus = 0;          // E', Pa
  double surface_energy = 0;   // gamma, J/m^2, of one flank, its atoms left where they are
  double stress_intensity = 0; // sqrt(2 gamma E'), Pa sqrt(m)
};

/// Of a crack across `normal` with its front along `front`, perpendicular unit vectors in space;
/// empty where planes across the front are no mirrors of the crystal.
std::optional<GriffithCrack> griffith_crack(const Crystal<3> &crystal, const Vector<3> &normal,
                                            const Vector<3> &front);
} // namespace ligament::md
