// One way to write sums and products of doubles, of vectors of lanes and of small vectors of both,
// so that a law is written once; compiled once for every instruction set.
#if defined(LIGAMENT_DEM_NUMBERS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LIGAMENT_DEM_NUMBERS_H
#undef LIGAMENT_DEM_NUMBERS_H
#else
#define LIGAMENT_DEM_NUMBERS_H
#endif

#include "dem/lane_vectors.h"
#include "dem/turn.h"

HWY_BEFORE_NAMESPACE();
namespace ligament::dem::HWY_NAMESPACE
{
template <typename V>
HWY_INLINE V mul(V a, V b)
{
  return hn::Mul(a, b);
}
HWY_INLINE double mul(double a, double b)
{
  return a * b;
}

/// a b + c
template <typename V>
HWY_INLINE V mul_add(V a, V b, V c)
{
  return hn::MulAdd(a, b, c);
}
HWY_INLINE double mul_add(double a, double b, double c)
{
  return a * b + c;
}

template <typename V>
HWY_INLINE V sub(V a, V b)
{
  return hn::Sub(a, b);
}
HWY_INLINE double sub(double a, double b)
{
  return a - b;
}

template <typename V>
HWY_INLINE V neg(V a)
{
  return hn::Neg(a);
}
HWY_INLINE double neg(double a)
{
  return -a;
}

/// s a of numbers and of vectors.
template <typename V>
HWY_INLINE V scaled(V s, V a)
{
  return hn::Mul(s, a);
}
template <typename V>
HWY_INLINE Pair<V> scaled(V s, const Pair<V> &a)
{
  return s * a;
}
template <typename V>
HWY_INLINE Triple<V> scaled(V s, const Triple<V> &a)
{
  return s * a;
}

/// number(1.5, like): 1.5 as a number of the type of `like` or of its components.
template <typename V>
HWY_INLINE V number(double value, const V &)
{
  return hn::Set(hn::DFromV<V>(), value);
}
template <typename V>
HWY_INLINE V number(double value, const Pair<V> &)
{
  return hn::Set(hn::DFromV<V>(), value);
}
template <typename V>
HWY_INLINE V number(double value, const Triple<V> &)
{
  return hn::Set(hn::DFromV<V>(), value);
}
HWY_INLINE double number(double value, double)
{
  return value;
}
template <int n>
HWY_INLINE double number(double value, const Vec<n> &)
{
  return value;
}

template <int n>
HWY_INLINE Vec<n> mul_add(double s, const Vec<n> &a, const Vec<n> &b)
{
  return s * a + b;
}
/// b - s a
template <int n>
HWY_INLINE Vec<n> neg_mul_add(double s, const Vec<n> &a, const Vec<n> &b)
{
  return b - s * a;
}
/// c - a b
template <typename V>
HWY_INLINE V neg_mul_add(V a, V b, V c)
{
  return hn::NegMulAdd(a, b, c);
}

template <int n>
HWY_INLINE double dot(const Vec<n> &a, const Vec<n> &b)
{
  return a.dot(b);
}
/// c + a x b
template <int n>
HWY_INLINE Spin<n> add_cross(const Vec<n> &a, const Vec<n> &b, const Spin<n> &c)
{
  return c + dem::cross(a, b);
}
} // namespace ligament::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
