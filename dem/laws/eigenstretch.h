// What plastic strains change in a bond, theory.md eq. (D21); of doubles or of vectors of lanes.
#if defined(LIGAMENT_DEM_EIGENSTRETCH_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LIGAMENT_DEM_EIGENSTRETCH_H
#undef LIGAMENT_DEM_EIGENSTRETCH_H
#else
#define LIGAMENT_DEM_EIGENSTRETCH_H
#endif

#include "dem/laws/numbers.h"

HWY_BEFORE_NAMESPACE();
namespace ligament::dem::HWY_NAMESPACE
{
/// Of a bond as one of its particles sees it, i: b = b_i + b_j is the part of Du that no traction
/// answers, b_i turns with i. From j the same holds with -Du and -b.
template <typename Number, typename Vector>
struct Eigenstretch
{
  Number shear; // 2G S/r, N/m

  /// What the force on i loses, in N.
  HWY_INLINE Vector lost(const Vector &b) const { return shear * b; }

  /// Adds its torque on i, whose present lever is a_i.
  template <typename Torque>
  HWY_INLINE Torque add_torque(const Vector &lost, const Vector &du, const Vector &a_i,
                               const Vector &b_i, const Torque &sum) const
  {
    return add_cross(b_i, Vector(shear * du - lost), add_cross(lost, a_i, sum));
  }

  /// Twice the energy in J that the bond loses, 1/2 k (|Du|^2 - |Du - b|^2).
  HWY_INLINE Number twice_lost_energy(const Vector &lost, const Vector &du, const Vector &b) const
  {
    return dot(lost, Vector(du + Vector(du - b)));
  }
};
} // namespace ligament::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
