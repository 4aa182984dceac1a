// Where the particles of a vector lie in the streams: side by side or anywhere; compiled once for
// every instruction set.
#if defined(LIGAMENT_DEM_PARTICLE_PLACES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LIGAMENT_DEM_PARTICLE_PLACES_H
#undef LIGAMENT_DEM_PARTICLE_PLACES_H
#else
#define LIGAMENT_DEM_PARTICLE_PLACES_H
#endif

#include "dem/inelastic/inelastic_sweep.h"
#include "dem/lane_vectors.h"

#include <hwy/cache_control.h>

#include <algorithm>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace ligament::dem::HWY_NAMESPACE
{
/// Particles that lie side by side, from i on.
template <int dim, typename D>
struct InARow
{
  using V = hn::Vec<D>;
  static constexpr int n = int(hn::MaxLanes(D()));
  long i;

  long particle(int lane) const { return i + lane; }
  HWY_INLINE bool any_open(const int *open) const
  {
    const hn::CappedTag<std::int32_t, n> d;
    return !hn::AllTrue(d, hn::Lt(hn::LoadU(d, open + i), hn::Zero(d)));
  }
  /// Whether all have the same of these numbers.
  HWY_INLINE bool is_same(const std::uint8_t *numbers) const
  {
    static_assert(n <= 8);
    std::uint64_t all = 0, ones = 0;
    std::memcpy(&all, numbers + i, n);
    std::memset(&ones, 1, n);
    return all == ones * numbers[i];
  }
  /// Asks for what streams hold some vectors after these: they are too many for the processor to
  /// follow by itself.
  template <typename Number>
  HWY_INLINE void prefetch(const Number *stream) const
  {
    hwy::Prefetch(stream + i + 64);
  }
  /// visit(block) of all that they lie in.
  template <typename Visit>
  HWY_INLINE void for_each_block(Visit &&visit) const
  {
    const long first = i / inelastic_block, last = (i + n - 1) / inelastic_block;
    visit(first);
    if (HWY_UNLIKELY(last != first))
      visit(last);
  }
  HWY_INLINE V load(D d, const double *stream) const { return hn::LoadU(d, stream + i); }
  HWY_INLINE void store(D d, V value, hn::Mask<D> where, double *stream) const
  {
    if (HWY_LIKELY(hn::AllTrue(d, where)))
      hn::StoreU(value, d, stream + i);
    else if constexpr (n > 1)
      hn::BlendedStore(value, where, d, stream + i);
    else if (lane_bits(d, where) &
             1) // a masked store would look at lanes behind the first one, too
      stream[i] = hn::GetLane(value);
  }
};

/// Particles anywhere in one block.
template <int dim, typename D>
struct Scattered
{
  using V = hn::Vec<D>;
  static constexpr int n = int(hn::MaxLanes(D()));
  int of[n];

  long particle(int lane) const { return of[lane]; }
  template <typename Visit>
  HWY_INLINE void for_each_block(Visit &&visit) const
  {
    visit(of[0] / inelastic_block);
  }
  HWY_INLINE bool any_open(const int *open) const
  {
    int any = -1;
    for (int l = 0; l < n; ++l)
      any = std::max(any, open[of[l]]);
    return any >= 0;
  }
  HWY_INLINE bool is_same(const std::uint8_t *numbers) const
  {
    bool same = true;
    for (int l = 1; l < n; ++l)
      same = same && numbers[of[l]] == numbers[of[0]];
    return same;
  }
  HWY_INLINE void prefetch(const double *) const {}
  HWY_INLINE V load(D d, const double *stream) const
  {
    HWY_ALIGN double value[n];
    for (int l = 0; l < n; ++l)
      value[l] = stream[of[l]];
    return hn::Load(d, value);
  }
  HWY_INLINE void store(D d, V value, hn::Mask<D> where, double *stream) const
  {
    HWY_ALIGN double values[n];
    hn::Store(value, d, values);
    const std::uint32_t lanes = lane_bits(d, where);
    for (int l = 0; l < n; ++l)
      if (lanes >> l & 1)
        stream[of[l]] = values[l];
  }
};
} // namespace ligament::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
