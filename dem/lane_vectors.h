// Small vectors of lanes: what a kernel needs of plane and space geometry, compiled once for every
// instruction set.
#if defined(LIGAMENT_DEM_LANE_VECTORS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LIGAMENT_DEM_LANE_VECTORS_H
#undef LIGAMENT_DEM_LANE_VECTORS_H
#else
#define LIGAMENT_DEM_LANE_VECTORS_H
#endif

#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace ligament::dem::HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// Two components of a vector of particles.
template <typename V>
struct Pair
{
  V x, y;
};

// Not friends: those are compiled for the machine at large, whose calling convention is another.
template <typename V>
HWY_INLINE Pair<V> operator+(const Pair<V> &a, const Pair<V> &b)
{
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y)};
}
template <typename V>
HWY_INLINE Pair<V> operator-(const Pair<V> &a, const Pair<V> &b)
{
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y)};
}
template <typename V>
HWY_INLINE Pair<V> operator*(V s, const Pair<V> &a)
{
  return {hn::Mul(s, a.x), hn::Mul(s, a.y)};
}

/// s a + b
template <typename V>
HWY_INLINE Pair<V> mul_add(V s, const Pair<V> &a, const Pair<V> &b)
{
  return {hn::MulAdd(s, a.x, b.x), hn::MulAdd(s, a.y, b.y)};
}
/// b - s a
template <typename V>
HWY_INLINE Pair<V> neg_mul_add(V s, const Pair<V> &a, const Pair<V> &b)
{
  return {hn::NegMulAdd(s, a.x, b.x), hn::NegMulAdd(s, a.y, b.y)};
}
/// c + a . b
template <typename V>
HWY_INLINE V add_dot(const Pair<V> &a, const Pair<V> &b, V c)
{
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, c));
}
template <typename V>
HWY_INLINE V dot(const Pair<V> &a, const Pair<V> &b)
{
  return hn::MulAdd(a.x, b.x, hn::Mul(a.y, b.y));
}
/// c + a x b
template <typename V>
HWY_INLINE V add_cross(const Pair<V> &a, const Pair<V> &b, V c)
{
  return hn::MulAdd(a.x, b.y, hn::NegMulAdd(a.y, b.x, c));
}

/// Three components of a vector of particles.
template <typename V>
struct Triple
{
  V x, y, z;
};

template <typename V>
HWY_INLINE Triple<V> operator+(const Triple<V> &a, const Triple<V> &b)
{
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
template <typename V>
HWY_INLINE Triple<V> operator-(const Triple<V> &a, const Triple<V> &b)
{
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
template <typename V>
HWY_INLINE Triple<V> operator*(V s, const Triple<V> &a)
{
  return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)};
}

/// s a + b
template <typename V>
HWY_INLINE Triple<V> mul_add(V s, const Triple<V> &a, const Triple<V> &b)
{
  return {hn::MulAdd(s, a.x, b.x), hn::MulAdd(s, a.y, b.y), hn::MulAdd(s, a.z, b.z)};
}
/// b - s a
template <typename V>
HWY_INLINE Triple<V> neg_mul_add(V s, const Triple<V> &a, const Triple<V> &b)
{
  return {hn::NegMulAdd(s, a.x, b.x), hn::NegMulAdd(s, a.y, b.y), hn::NegMulAdd(s, a.z, b.z)};
}
/// c + a . b
template <typename V>
HWY_INLINE V add_dot(const Triple<V> &a, const Triple<V> &b, V c)
{
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::MulAdd(a.z, b.z, c)));
}
template <typename V>
HWY_INLINE V dot(const Triple<V> &a, const Triple<V> &b)
{
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
/// c + a x b
template <typename V>
HWY_INLINE Triple<V> add_cross(const Triple<V> &a, const Triple<V> &b, const Triple<V> &c)
{
  return {hn::MulAdd(a.y, b.z, hn::NegMulAdd(a.z, b.y, c.x)),
          hn::MulAdd(a.z, b.x, hn::NegMulAdd(a.x, b.z, c.y)),
          hn::MulAdd(a.x, b.y, hn::NegMulAdd(a.y, b.x, c.z))};
}

/// Quaternion w + v.
template <typename V>
struct Quaternion
{
  V w;
  Triple<V> v;
};
template <typename V>
HWY_INLINE V dot(const Quaternion<V> &a, const Quaternion<V> &b)
{
  return add_dot(a.v, b.v, hn::Mul(a.w, b.w));
}
template <typename V>
HWY_INLINE Quaternion<V> mul_add(V s, const Quaternion<V> &a, const Quaternion<V> &b)
{
  return {hn::MulAdd(s, a.w, b.w), mul_add(s, a.v, b.v)};
}
/// b + q n
template <typename V>
HWY_INLINE Quaternion<V> add_product(const Quaternion<V> &q, const Triple<V> &n,
                                     const Quaternion<V> &b)
{
  return {hn::NegMulAdd(q.v.x, n.x, hn::NegMulAdd(q.v.y, n.y, hn::NegMulAdd(q.v.z, n.z, b.w))),
          add_cross(q.v, n, mul_add(q.w, n, b.v))};
}

/// Bit n: lane n is true.
template <typename D>
HWY_INLINE std::uint32_t lane_bits(D d, hn::Mask<D> mask)
{
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  return bytes[0];
}

/// Where the force f on a face has a tension, and sigma + tangent |tau| of it times the face
/// reaches `strength`; along `normal`, of any length. To 1e-7 where tau is small. With a tangent
/// below 0 where max(sigma, 0)^2 + tau^2 reaches strength^2, or a little less.
template <typename D, typename Vector, typename V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> reaches(D d, const Vector &f, const Vector &normal, V strength,
                               double tangent)
{
  const V zero = hn::Zero(d);
  const V tension = add_dot(f, normal, zero), length2 = add_dot(normal, normal, zero);
  const V shear2 = hn::NegMulAdd(tension, tension, hn::Mul(add_dot(f, f, zero), length2));
  if (tangent < 0) {
    constexpr double round_off = 1e-14;
    const V force2 = hn::Mul(add_dot(f, f, zero), length2);
    const V freed2 = hn::IfThenElse(hn::Gt(tension, zero), force2,
                                    hn::MulAdd(hn::Set(d, round_off), force2, shear2));
    return hn::Ge(freed2, hn::Mul(hn::Mul(strength, strength), length2));
  }
  const V reached = hn::MulAdd(hn::Set(d, tangent), hn::Sqrt(hn::Max(shear2, zero)), tension);
  return hn::And(hn::Gt(tension, zero), hn::Ge(reached, hn::Mul(strength, hn::Sqrt(length2))));
}
} // namespace ligament::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
