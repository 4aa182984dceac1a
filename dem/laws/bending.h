// Bending and twist of a bond, theory.md eq. (D4): couples and energy; of doubles or of vectors of
// lanes, bond by bond or summed over the bonds of a lattice.
#if defined(LIGAMENT_DEM_BENDING_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LIGAMENT_DEM_BENDING_H
#undef LIGAMENT_DEM_BENDING_H
#else
#define LIGAMENT_DEM_BENDING_H
#endif

#include "dem/laws/numbers.h"

HWY_BEFORE_NAMESPACE();
namespace ligament::dem::HWY_NAMESPACE
{
/// Of a bond in the plane, or of several of one stiffness.
template <typename Number>
struct PlaneBending
{
  Number bending; // k_b, N m

  /// On i, from phi_j - phi_i or the sum of these.
  HWY_INLINE Number add_torque(Number turn, Number sum) const
  {
    return mul_add(bending, turn, sum);
  }
  /// Adds twice the energy in J, from (phi_j - phi_i)^2 or the sum of these.
  HWY_INLINE Number add_twice_energy(Number turn2, Number sum) const
  {
    return mul_add(bending, turn2, sum);
  }
};

/// Vector part of conj(Q_i) Q_j: the rotation of j as i sees it.
template <typename Number, typename Vector>
HWY_INLINE Vector relative_turn(Number w_i, const Vector &v_i, Number w_j, const Vector &v_j)
{
  return add_cross(v_j, v_i, Vector(w_i * v_j - w_j * v_i));
}

/// Of a bond in space, or of several of one stiffness; (w, v) is the rotation of j as i sees it.
template <typename Number>
struct SpaceBending
{
  Number bending; // k_b, N m
  Number twist;   // k_t - k_b over the square of the length of the normal

  /// Adds half the couple on i in its own axes, eq. (D8d).
  template <typename Vector>
  HWY_INLINE Vector add_half_couple(const Vector &normal, Number w, const Vector &v,
                                    const Vector &sum) const
  {
    const Number c = mul(twist, dot(normal, v));
    const Vector bent = mul_add(mul(bending, w), v, sum);
    return add_cross(Vector(c * v), normal, mul_add(mul(c, w), normal, bent));
  }

  /// Adds half the energy in J, from |v|^2 and (n . v)^2 or the sums of these.
  HWY_INLINE Number add_half_energy(Number v2, Number vn2, Number sum) const
  {
    return mul_add(twist, vn2, mul_add(bending, v2, sum));
  }
};

/// All bonds of a particle on a lattice: the torque is the vector part of one quaternion,
/// 2 [k_b sum_j w_j Q_j + (k_t - k_b) sum_j s_j Q_j n] conj(Q_i).
template <typename V>
struct LatticeBending
{
  Quaternion<V> bent, twisted;

  HWY_INLINE explicit LatticeBending(V zero)
      : bent{zero, {zero, zero, zero}}, twisted{zero, {zero, zero, zero}}
  {
  }

  /// The bonds along n to the particles of orientation q_f and q_b; carries_f(x) is x where the
  /// first one carries and 0 elsewhere.
  template <typename Forward, typename Backward>
  HWY_INLINE void add(const Quaternion<V> &q, const Triple<V> &n, const Quaternion<V> &q_f,
                      Forward &&carries_f, const Quaternion<V> &q_b, Backward &&carries_b)
  {
    const V zero = number(0, q.w);
    const Quaternion<V> none{zero, {zero, zero, zero}};
    // With w the real part of the rotation of j as i sees it and s its part along n:
    // bending w q_j, twist s q_j n.
    bent = mul_add(carries_f(dot(q, q_f)), q_f, bent);
    bent = mul_add(carries_b(dot(q, q_b)), q_b, bent);
    const Quaternion<V> qn = add_product(q, n, none);
    Quaternion<V> turned = mul_add(carries_f(dot(qn, q_f)), q_f, none);
    turned = mul_add(carries_b(dot(qn, q_b)), q_b, turned);
    twisted = add_product(turned, n, twisted);
  }

  HWY_INLINE Triple<V> add_torque(const Quaternion<V> &q, V two_bending, V two_twist,
                                  const Triple<V> &sum) const
  {
    const Quaternion<V> m =
        mul_add(two_twist, twisted, Quaternion<V>{mul(two_bending, bent.w), two_bending * bent.v});
    return add_cross(q.v, m.v, mul_add(q.w, m.v, neg_mul_add(m.w, q.v, sum)));
  }
};
} // namespace ligament::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
