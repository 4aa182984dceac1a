// From rows of numbers to vectors of lanes; compiled once for every instruction set.
#if defined(LIGAMENT_DEM_TRANSPOSE_LANES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LIGAMENT_DEM_TRANSPOSE_LANES_H
#undef LIGAMENT_DEM_TRANSPOSE_LANES_H
#else
#define LIGAMENT_DEM_TRANSPOSE_LANES_H
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace ligament::dem::HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// Each for all lanes.
template <typename D>
struct EightNumbers
{
  hn::Vec<D> number[8];
};

/// Transposes rows of eight numbers in registers, twice as fast as gathering numbers one by one;
/// row(n) is where the numbers of lane n start.
template <typename D, typename Row>
HWY_INLINE EightNumbers<D> transpose(D d, Row &&row)
{
  EightNumbers<D> r;
  constexpr int n = int(hn::MaxLanes(D()));
  if constexpr (n == 1)
    for (int c = 0; c < 8; ++c)
      r.number[c] = hn::LoadU(d, row(0) + c);
#if HWY_TARGET != HWY_SCALAR
  else if constexpr (n == 8) {
    const hn::Half<D> half;
    for (int c = 0; c < 8; c += 4) {
      const auto two_rows = [&](int k) HWY_ATTR {
        return hn::Combine(d, hn::LoadU(half, row(k + 4) + c), hn::LoadU(half, row(k) + c));
      };
      const auto v0 = two_rows(0), v1 = two_rows(1), v2 = two_rows(2), v3 = two_rows(3);
      const auto even_a = hn::InterleaveLower(d, v0, v1), odd_a = hn::InterleaveUpper(d, v0, v1);
      const auto even_b = hn::InterleaveLower(d, v2, v3), odd_b = hn::InterleaveUpper(d, v2, v3);
      r.number[c] = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(even_b), even_a);
      r.number[c + 1] = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(odd_b), odd_a);
      r.number[c + 2] = hn::OddEvenBlocks(even_b, hn::SwapAdjacentBlocks(even_a));
      r.number[c + 3] = hn::OddEvenBlocks(odd_b, hn::SwapAdjacentBlocks(odd_a));
    }
  } else
    for (int c = 0; c < 8; c += 2) {
      const auto every_other = [&](int k) HWY_ATTR {
        if constexpr (n == 4) {
          const hn::Half<D> half;
          return hn::Combine(d, hn::LoadU(half, row(k + 2) + c), hn::LoadU(half, row(k) + c));
        } else
          return hn::LoadU(d, row(k) + c);
      };
      const auto a = every_other(0), b = every_other(1);
      r.number[c] = hn::InterleaveLower(d, a, b);
      r.number[c + 1] = hn::InterleaveUpper(d, a, b);
    }
#endif
  return r;
}
} // namespace ligament::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
