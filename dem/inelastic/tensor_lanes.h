// Symmetric tensors of vectors of particles; compiled once for every instruction set.
#if defined(LIGAMENT_DEM_TENSOR_LANES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LIGAMENT_DEM_TENSOR_LANES_H
#undef LIGAMENT_DEM_TENSOR_LANES_H
#else
#define LIGAMENT_DEM_TENSOR_LANES_H
#endif

#include "dem/inelastic/inelastic_sweep.h"
#include "dem/lane_vectors.h"

HWY_BEFORE_NAMESPACE();
namespace ligament::dem::HWY_NAMESPACE
{
/// Components as n_tensor has them.
template <int dim, typename V>
struct SymmetricTensor
{
  V c[n_tensor<dim>];

  HWY_INLINE V operator()(int a, int b) const { return c[tensor_place<dim>(a, b)]; }
};

template <int dim, typename V>
HWY_INLINE SymmetricTensor<dim, V> zero_tensor(V zero)
{
  SymmetricTensor<dim, V> t;
  for (int c = 0; c < n_tensor<dim>; ++c)
    t.c[c] = zero;
  return t;
}

/// A third of the trace.
template <typename D, int dim, typename V>
HWY_INLINE V mean(D d, const SymmetricTensor<dim, V> &t)
{
  return hn::Mul(hn::Set(d, 1 / 3.), hn::Add(t.c[0], hn::Add(t.c[1], t.c[2])));
}

template <typename D, int dim, typename V>
HWY_INLINE SymmetricTensor<dim, V> deviator(D d, const SymmetricTensor<dim, V> &t)
{
  SymmetricTensor<dim, V> s = t;
  const V middle = mean(d, t);
  for (int c = 0; c < 3; ++c)
    s.c[c] = hn::Sub(t.c[c], middle);
  return s;
}

/// a : b
template <int dim, typename V>
HWY_INLINE V double_dot(const SymmetricTensor<dim, V> &a, const SymmetricTensor<dim, V> &b)
{
  V off = hn::Mul(a.c[3], b.c[3]);
  for (int c = 4; c < n_tensor<dim>; ++c)
    off = hn::MulAdd(a.c[c], b.c[c], off);
  V sum = hn::Add(off, off);
  for (int c = 0; c < 3; ++c)
    sum = hn::MulAdd(a.c[c], b.c[c], sum);
  return sum;
}
template <int dim, typename V>
HWY_INLINE V double_dot(const SymmetricTensor<dim, V> &a)
{
  return double_dot(a, a);
}
} // namespace ligament::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
