// Vectors of lanes that look up tables; compiled once for every instruction set.
#if defined(LIGAMENT_MD_TABLE_LANES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LIGAMENT_MD_TABLE_LANES_H
#undef LIGAMENT_MD_TABLE_LANES_H
#else
#define LIGAMENT_MD_TABLE_LANES_H
#endif

#include "md/pair_table.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace ligament::md::HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;
constexpr int lanes = int(hn::MaxLanes(D()));

/// Four numbers of each lane, one lane after the other in a vector.
struct Columns
{
  V a, b, c, d;
};

#if HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128 // plain code: lane by lane
template <typename Index>
HWY_INLINE Columns load_columns(const double *first, int stride, const Index *index)
{
  const D d;
  HWY_ALIGN double columns[4][lanes];
  for (int lane = 0; lane < lanes; ++lane)
    for (int c = 0; c < 4; ++c)
      columns[c][lane] = first[std::ptrdiff_t(stride) * index[lane] + c];
  return {hn::Load(d, columns[0]), hn::Load(d, columns[1]), hn::Load(d, columns[2]),
          hn::Load(d, columns[3])};
}
#else
/// Vectors of [a b | c d] of lanes 0 and 4, 1 and 5, ... become columns.
HWY_INLINE Columns transposed(V r0, V r1, V r2, V r3)
{
  const D d;
  const V ac01 = hn::InterleaveLower(d, r0, r1), bd01 = hn::InterleaveUpper(d, r0, r1),
          ac23 = hn::InterleaveLower(d, r2, r3), bd23 = hn::InterleaveUpper(d, r2, r3);
  return {hn::OddEvenBlocks(hn::SwapAdjacentBlocks(ac23), ac01),
          hn::OddEvenBlocks(hn::SwapAdjacentBlocks(bd23), bd01),
          hn::OddEvenBlocks(ac23, hn::SwapAdjacentBlocks(ac01)),
          hn::OddEvenBlocks(bd23, hn::SwapAdjacentBlocks(bd01))};
}

/// The four numbers at first + stride * index[lane] for each lane.
template <typename Index>
HWY_INLINE Columns load_columns(const double *first, int stride, const Index *index)
{
  const D d;
  const auto row = [&](int lane) HWY_ATTR {
    const double *const at = first + std::ptrdiff_t(stride) * index[lane];
    if constexpr (lanes == 8) {
      const hn::Half<D> half;
      return hn::Combine(d,
                         hn::LoadU(half, first + std::ptrdiff_t(stride) * index[lane + lanes / 2]),
                         hn::LoadU(half, at));
    } else
      return hn::LoadU(d, at);
  };
  return transposed(row(0), row(1), row(2), row(3));
}
#endif

/// 1/sqrt(x), x > 0 and normal, to a few units of the last digit.
HWY_INLINE V inverse_root(V x)
{
  const D d;
#if HWY_TARGET == HWY_AVX3
  // From 14 bits by a step of third and one of second order: the divider is slower.
  const V y{_mm512_rsqrt14_pd(x.raw)}, half = hn::Set(d, 0.5);
  const V e = hn::NegMulAdd(x, hn::Mul(y, y), hn::Set(d, 1.)),
          z = hn::MulAdd(hn::Mul(y, e), hn::MulAdd(e, hn::Set(d, 0.375), half), y),
          rest = hn::NegMulAdd(x, hn::Mul(z, z), hn::Set(d, 1.));
  return hn::MulAdd(hn::Mul(z, half), rest, z);
#else
  return hn::Div(hn::Set(d, 1.), hn::Sqrt(x));
#endif
}

/// f and its derivative by t, at t in the interval.
struct ValueSlope
{
  V value, slope;
};
HWY_INLINE ValueSlope cubic(const Columns &c, V t)
{
  const V inner = hn::MulAdd(c.d, t, c.c), middle = hn::MulAdd(inner, t, c.b);
  return {hn::MulAdd(middle, t, c.a), hn::MulAdd(hn::MulAdd(c.d, t, inner), t, middle)};
}
HWY_INLINE V parabola(const Columns &c, V t)
{
  return hn::MulAdd(hn::MulAdd(c.c, t, c.b), t, c.a);
}

/// phi as a cubic of t, from what the table has of it.
HWY_INLINE Columns pair_cubic(const Columns &pull, double inverse_step)
{
  const D d;
  const double step = -1 / inverse_step;
  return {pull.d, hn::Mul(hn::Set(d, step), pull.a), hn::Mul(hn::Set(d, step / 2), pull.b),
          hn::Mul(hn::Set(d, step / 3), pull.c)};
}
HWY_INLINE V pair_energy(const Columns &pull, V t, double inverse_step)
{
  const Columns phi = pair_cubic(pull, inverse_step);
  return hn::MulAdd(hn::MulAdd(hn::MulAdd(phi.d, t, phi.c), t, phi.b), t, phi.a);
}
} // namespace ligament::md::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
