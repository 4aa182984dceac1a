// The loops over rows that both dimensions share, compiled once for every instruction set; what a
// vector of neighbouring particles answers comes in as a policy `Bonds`.
#if defined(LIGAMENT_DEM_LATTICE_ROWS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LIGAMENT_DEM_LATTICE_ROWS_H
#undef LIGAMENT_DEM_LATTICE_ROWS_H
#else
#define LIGAMENT_DEM_LATTICE_ROWS_H
#endif

#include "dem/lattice_kernel.h"

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace ligament::dem::HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::ScalableTag<double>;
using OneLane = hn::CappedTag<double, 1>;

/// Which of the bonds of a vector of particles carry.
template <typename D>
struct BondMask
{
  hn::Vec<hn::Rebind<std::uint64_t, D>> bits;

  HWY_INLINE BondMask(D, const std::uint32_t *mask, long i)
      : bits(hn::PromoteTo(hn::Rebind<std::uint64_t, D>(),
                           hn::LoadU(hn::Rebind<std::uint32_t, D>(), mask + i)))
  {
  }
  /// v where bond k carries, 0 elsewhere.
  template <typename V>
  HWY_INLINE V operator()(V v, int k) const
  {
    const hn::Rebind<std::uint64_t, D> d;
    const auto carries = hn::TestBit(bits, hn::Set(d, std::uint64_t(1) << k));
    return hn::IfThenElseZero(hn::RebindMask(D(), carries), v);
  }
};

/// Asks for what several arrays hold some vectors after particle i: there are more of them than the
/// processor follows by itself.
template <typename Arrays>
HWY_INLINE void prefetch(const Arrays &arrays, long i)
{
  constexpr long ahead = 64;
  for (const double *const array : arrays)
    hwy::Prefetch(array + i + ahead);
}

/// Calls visit(d, i) for whole vectors that cover [begin, end) and nothing outside [first, end):
/// the last one overlaps what came before, results are the same bits again. A row shorter than a
/// vector goes one by one.
template <typename Visit>
HWY_INLINE void for_each_vector(long first, long begin, long end, Visit &&visit)
{
  const Lanes d;
  const long n = long(hn::Lanes(d));
  if (end - first < n) {
    for (long i = begin; i < end; ++i)
      visit(OneLane(), i);
    return;
  }
  long i = begin;
  for (; i + n <= end; i += n)
    visit(d, i);
  if (i < end)
    visit(d, end - n);
}

/// Three stages, each as far ahead of the next as its neighbours need: turn (of each particle by
/// itself), dilatation, forces or energies.
template <typename Bonds, int dim>
class RowPipeline
{
public:
  HWY_INLINE explicit RowPipeline(const RowSweep<dim> &sweep) : sweep_(sweep), bonds_(sweep)
  {
    // Sliding takes little time when the window is twice as long as it must be.
    const long length = std::min(2 * sweep.window_length(), Bonds::stride);
    sweep.window->reset(Bonds::n_streams, Bonds::stride,
                        int(std::min(length, long(sweep.n_particles))));
  }

  HWY_INLINE void run()
  {
    if (!sweep_.with_forces) {
      dilate_to(sweep_.n_particles);
      return;
    }
    for (const RowSegment &segment : *sweep_.segments)
      for (int begin = segment.begin; begin < segment.end; begin += piece) {
        const int end = std::min(begin + piece, segment.end);
        forces_at_ = begin;
        dilate_to(std::min(end + sweep_.reach, sweep_.n_particles));
        bonds_.set_window(sweep_.window->origin());
        if (sweep_.energy)
          energies(segment, begin, end);
        else
          forces(segment, begin, end);
      }
  }

private:
  static constexpr int piece = row_piece;

  HWY_INLINE void dilate_to(int target)
  {
    if (!sweep_.volumetric)
      turn_to(target);
    while (sweep_.volumetric && dilated_ < target) {
      const RowSegment &segment = (*sweep_.segments)[segment_];
      const int begin = dilated_, end = std::min(begin + piece, segment.end);
      if (!sweep_.with_forces)
        forces_at_ = begin;
      turn_to(std::min(end + sweep_.reach, sweep_.n_particles));
      bonds_.set_window(sweep_.window->origin());
      dilatation(segment, begin, end);
      dilated_ = end;
      segment_ += end == segment.end;
    }
  }

  HWY_INLINE void turn_to(int target)
  {
    while (turned_ < target) {
      const int end = std::min(turned_ + piece, target);
      sweep_.window->slide(std::max(forces_at_ - sweep_.reach, 0), end);
      bonds_.set_window(sweep_.window->origin());
      // Overlapping vectors stay within this piece: what lies before may have left the window.
      for_each_vector(turned_, turned_, end, [&](auto d, long i) HWY_ATTR { bonds_.turn(d, i); });
      turned_ = end;
    }
  }

  HWY_INLINE void dilatation(const RowSegment &segment, int begin, int end)
  {
    const typename Bonds::Offsets offsets(segment);
    for_each_vector(segment.begin, begin, end,
                    [&](auto d, long i) HWY_ATTR { bonds_.dilatation(d, i, offsets); });
  }

  HWY_INLINE void forces(const RowSegment &segment, int begin, int end)
  {
    const typename Bonds::Offsets offsets(segment);
    int done = begin;
    for_each_vector(segment.begin, begin, end, [&](auto d, long i) HWY_ATTR {
      const int after = int(i) + int(hn::Lanes(d));
      if (HWY_UNLIKELY(bonds_.forces(d, i, offsets)))
        note(d, i, offsets, {std::max(int(i), done), after});
      done = after;
    });
  }

  /// Where the limit was reached: marks of the screen, and bonds that exceed the strength.
  template <typename D>
  HWY_INLINE void note(D d, long i, const typename Bonds::Offsets &offsets, const RowRange &range)
  {
    if (sweep_.screen.traction > 0) {
      sweep_.screen.mark(range.begin);
      sweep_.screen.mark(range.end - 1);
    }
    if (std::isfinite(sweep_.constants.strength2) && bonds_.exceeds(d, i, offsets))
      sweep_.exceeded->push_back(range);
  }

  HWY_INLINE void energies(const RowSegment &segment, int begin, int end)
  {
    const typename Bonds::Offsets offsets(segment);
    for_each_vector(segment.begin, begin, end, [&](auto d, long i) HWY_ATTR {
      hn::StoreU(bonds_.energy(d, i, offsets), d, sweep_.energy + i);
    });
  }

  const RowSweep<dim> &sweep_;
  Bonds bonds_;
  int segment_ = 0;
  int turned_ = 0, dilated_ = 0, forces_at_ = 0; // fronts of the stages
};

/// Indices of the neighbours against those of the particles.
template <int n_dir>
struct NeighbourOffsets
{
  std::array<long, n_dir> forward, backward;

  HWY_INLINE explicit NeighbourOffsets(const RowSegment &segment)
  {
    for (int k = 0; k < n_dir; ++k) {
      forward[k] = segment.forward[k];
      backward[k] = segment.backward[k];
    }
  }
};
} // namespace ligament::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
