// The elastic bond, theory.md section 1.3: forces, what it adds to the dilatation, energy; of
// doubles or of vectors of lanes, bond by bond or in the form for whole lattices.
#if defined(LIGAMENT_DEM_ELASTIC_BOND_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LIGAMENT_DEM_ELASTIC_BOND_H
#undef LIGAMENT_DEM_ELASTIC_BOND_H
#else
#define LIGAMENT_DEM_ELASTIC_BOND_H
#endif

#include "dem/laws/numbers.h"

HWY_BEFORE_NAMESPACE();
namespace ligament::dem::HWY_NAMESPACE
{
/// A bond as one of its particles sees it, i: Du is the motion of the other one, j, against it, a
/// are the present levers, p = lambda theta. From j the same holds with -Du and the sides swapped.
template <typename Number, typename Vector>
struct ElasticBond
{
  Number shear;  // 2G S/r, N/m, times the weight of its energy
  Number area_r; // S/r, m

  /// On i, S t of eq. (D8), in N.
  HWY_INLINE Vector force(const Vector &du, Number p_i, const Vector &a_i, Number p_j,
                          const Vector &a_j) const
  {
    const Number s_i = mul(area_r, p_i), s_j = mul(area_r, p_j);
    return mul_add(shear, du, Vector(s_i * a_i - s_j * a_j));
  }

  /// The same of a wall, which has no pressure.
  HWY_INLINE Vector force(const Vector &du, Number p_i, const Vector &a_i) const
  {
    return mul_add(shear, du, Vector(mul(area_r, p_i) * a_i));
  }

  /// Adds its torque on i, eq. (D8b), bending aside: theta depends on the lever that turns.
  template <typename Torque>
  HWY_INLINE Torque add_torque(const Vector &force, const Vector &du, Number p_i, const Vector &a_i,
                               const Torque &sum) const
  {
    return add_cross(a_i, neg_mul_add(mul(area_r, p_i), du, force), sum);
  }

  /// Adds its part of V theta of i, eq. (D6), in m^3.
  HWY_INLINE Number add_dilatation(const Vector &du, const Vector &a_i, Number sum) const
  {
    return mul_add(area_r, dot(a_i, du), sum);
  }

  /// Twice its energy in J, pressures and bending aside.
  HWY_INLINE Number twice_energy(const Vector &du) const { return mul(shear, dot(du, du)); }
};

/// The bonds of a whole lattice, eq. (D8c): all levers are q n, and with h = (R - I) n the force is
/// that of the displacements and a part g of each particle, which serves all its bonds. The numbers
/// of its functions are doubles or vectors of lanes.
struct LatticeBonds
{
  double shear;      // 2G S/r, N/m
  double half;       // q = r/2, m
  double shear_half; // 2G S/r q, N
  double volumetric; // v / p = S q/r, m^2

  /// Du from u_j - u_i and h_i + h_j.
  template <typename Vector>
  HWY_INLINE Vector relative(const Vector &u, const Vector &h) const
  {
    return neg_mul_add(number(half, u), h, u);
  }

  /// v p of a pressure.
  template <typename Number>
  HWY_INLINE Number pressing(Number p) const
  {
    return mul(number(volumetric, p), p);
  }
  /// g = v p n + (v p - 2G S/r q) h of a particle, from v p.
  template <typename Number, typename Vector>
  HWY_INLINE Vector part(Number vp, const Vector &n, const Vector &h) const
  {
    return mul_add(vp, n, Vector(sub(vp, number(shear_half, vp)) * h));
  }
  /// The same from the parts of h along n and across it in the plane, and as such parts.
  template <typename Number, typename Pair>
  HWY_INLINE Pair part_along(Number vp, const Pair &h) const
  {
    const Number factor = sub(vp, number(shear_half, vp));
    return {mul_add(factor, h.x, vp), mul(factor, h.y)};
  }
  /// Of particles without a volumetric stiffness.
  template <typename Vector>
  HWY_INLINE Vector part(const Vector &h) const
  {
    return number(-shear_half, h) * h;
  }

  /// On i, from u_j - u_i and g_i + g_j, in N.
  template <typename Vector>
  HWY_INLINE Vector force(const Vector &u, const Vector &g) const
  {
    return mul_add(number(shear, u), u, g);
  }

  /// p = lambda theta of a particle from lambda / V, the sum of (n + h) . Du over its bonds, and
  /// what is no lattice bond's.
  template <typename Number>
  HWY_INLINE Number pressure(Number lambda_per_volume, Number sum, Number others) const
  {
    return mul_add(mul(number(volumetric, sum), lambda_per_volume), sum, others);
  }

  /// On a particle from the sum of (n + h) x S t, bending aside.
  template <typename Torque>
  HWY_INLINE Torque torque(const Torque &of_forces) const
  {
    return scaled(number(half, of_forces), of_forces);
  }
  /// What pressure adds to it, from the sum of (n + h) x Du.
  template <typename Number, typename Torque>
  HWY_INLINE Torque add_torque_of_pressure(Number p, const Torque &of_motion,
                                           const Torque &sum) const
  {
    return neg_mul_add(pressing(p), of_motion, sum);
  }

  /// Twice the energy in J of bonds with this sum of |Du|^2, pressures and bending aside.
  template <typename Number>
  HWY_INLINE Number twice_energy(Number du2) const
  {
    return mul(number(shear, du2), du2);
  }
};
} // namespace ligament::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
