// The loops over rows that both dimensions share, compiled once for every instruction set; what a
// vector of neighbouring particles answers comes in as a policy `Bonds`.
#if defined(LIGAMENT_DEM_LATTICE_ROWS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LIGAMENT_DEM_LATTICE_ROWS_H
#undef LIGAMENT_DEM_LATTICE_ROWS_H
#else
#define LIGAMENT_DEM_LATTICE_ROWS_H
#endif

#include "dem/lane_vectors.h"
#include "dem/lattice_kernel.h"
#include "dem/stress_bound.h"

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
  /// a where bond k carries, b elsewhere.
  template <typename V>
  HWY_INLINE V select(V a, V b, int k) const
  {
    const hn::Rebind<std::uint64_t, D> d;
    const auto carries = hn::TestBit(bits, hn::Set(d, std::uint64_t(1) << k));
    return hn::IfThenElse(hn::RebindMask(D(), carries), a, b);
  }
  /// Where the first n bonds all carry.
  HWY_INLINE hn::Mask<D> all(int n) const
  {
    const hn::Rebind<std::uint64_t, D> d;
    const auto every = hn::Set(d, (std::uint64_t(1) << n) - 1);
    return hn::RebindMask(D(), hn::Eq(hn::And(bits, every), every));
  }
};

/// Particles with a face that could break by eq. (D12d) or (D12f), from sums over all their faces
/// of products of levers (of length 1) and forces, of moments, and of forces^2 (twice). Particles
/// that miss a face or have turned far are those with a force that reaches the limit.
template <int n_dir, int dim, typename D, typename Stress, typename Moment, typename V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> not_cleared(D d, const LatticeConstants<dim> &c, const BondMask<D> &mask,
                                   V angle, Stress stress, const Moment &moment, V twice_force2)
{
  constexpr double faces = 2 * n_dir, share = dim / faces; // S q / V of a face
  constexpr double most_turn = 0.004;                      // rad: takes 0.7 % of the strength
  const V force2 = hn::Mul(hn::Set(d, 0.5), twice_force2);
  stress.finish(moment, hn::Set(d, share));
  // The sum of |t - S n|^2: the sum of n n is that of the unit tensor.
  const V residual2 = hn::NegMulAdd(hn::Set(d, 1 / share), stress.square(), force2);
  const V bound = tension_bound(stress, residual2, most_turn, c.measure);
  const auto known = hn::And(mask.all(2 * n_dir), hn::Lt(angle, hn::Set(d, most_turn)));
  const auto cleared = hn::And(known, hn::Lt(bound, hn::Set(d, c.strength)));
  return hn::AndNot(cleared, hn::Ge(force2, hn::Set(d, c.limit2)));
}

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

/// Goes over ranges of particles in pieces that stay within a segment.
class PieceCursor
{
public:
  HWY_INLINE PieceCursor(const std::vector<RowSegment> &segments,
                         const std::vector<RowRange> &ranges)
      : segments_(segments), ranges_(ranges)
  {
    find();
  }

  HWY_INLINE bool has_more() const { return range_ < ranges_.size(); }
  HWY_INLINE void next()
  {
    begin = end;
    find();
  }
  const RowSegment &segment() const { return segments_[segment_]; }

  int begin = 0, end = 0;
  int first = 0; // where the segment, or the range if it begins later, begins

private:
  HWY_INLINE void find()
  {
    while (range_ < ranges_.size() && begin >= ranges_[range_].end)
      ++range_;
    if (range_ == ranges_.size())
      return;
    const RowRange &range = ranges_[range_];
    begin = std::max(begin, range.begin);
    while (segments_[segment_].end <= begin)
      ++segment_;
    first = std::max(segments_[segment_].begin, range.begin);
    end = std::min({begin + row_piece, segments_[segment_].end, range.end});
  }

  const std::vector<RowSegment> &segments_;
  const std::vector<RowRange> &ranges_;
  std::size_t segment_ = 0, range_ = 0;
};

/// Three stages, each as far ahead of the next as its neighbours need: turn (of each particle by
/// itself), dilatation, forces or energies.
template <typename Bonds, int dim>
class RowPipeline
{
public:
  HWY_INLINE explicit RowPipeline(const RowSweep<dim> &sweep)
      : sweep_(sweep), bonds_(sweep), dilated_(*sweep.segments, sweep.ranges->pressed)
  {
    sweep.window->reset(Bonds::n_streams, Bonds::stride, sweep.window_length(), sweep.n_particles);
  }

  HWY_INLINE void run()
  {
    if (!sweep_.with_forces) {
      forces_at_ = sweep_.n_particles;
      dilate_to(sweep_.n_particles);
      return;
    }
    for (PieceCursor piece(*sweep_.segments, sweep_.ranges->stepped); piece.has_more();
         piece.next()) {
      forces_at_ = piece.begin;
      dilate_to(std::min(piece.end + sweep_.reach, sweep_.n_particles));
      bonds_.set_window(sweep_.window->origin());
      if (sweep_.energy)
        energies(piece);
      else if (sweep_.by_particle)
        forces<true>(piece);
      else
        forces<false>(piece);
    }
    // Bonds of the table may reach farther than those of the lattice.
    forces_at_ = sweep_.n_particles;
    dilate_to(sweep_.n_particles);
  }

private:
  static constexpr int piece_size = row_piece;

  HWY_INLINE void dilate_to(int target)
  {
    if (!sweep_.volumetric)
      turn_to(target, forces_at_);
    for (; sweep_.volumetric && dilated_.has_more() && dilated_.begin < target; dilated_.next()) {
      turn_to(std::min(dilated_.end + sweep_.reach, sweep_.n_particles),
              std::min(forces_at_, dilated_.begin));
      bonds_.set_window(sweep_.window->origin());
      dilatation(dilated_);
    }
  }

  /// What the particles from `needed` on see must stay in the window, and what the vector before
  /// them sees that may overlap theirs.
  HWY_INLINE void turn_to(int target, int needed)
  {
    const int keep = std::max(needed - sweep_.reach - most_lanes, 0);
    const auto &ranges = sweep_.ranges->turned;
    for (; turning_ < ranges.size(); ++turning_) {
      turned_ = std::max({turned_, ranges[turning_].begin, keep});
      const int stop = std::min(ranges[turning_].end, target);
      while (turned_ < stop) {
        const int end = std::min(turned_ + piece_size, stop);
        sweep_.window->slide(keep, end);
        bonds_.set_window(sweep_.window->origin());
        // Overlapping vectors stay within this piece: what lies before may have left the window.
        for_each_vector(turned_, turned_, end, [&](auto d, long i) HWY_ATTR { bonds_.turn(d, i); });
        if (sweep_.volumetric && !Bonds::inelastic)
          take_other_pressures(turned_, end);
        turned_ = end;
      }
      if (ranges[turning_].end > target)
        return;
    }
  }

  /// Into the window, of those in [begin, end); each piece comes after the last.
  HWY_INLINE void take_other_pressures(int begin, int end)
  {
    const std::vector<int> &others = *sweep_.arrays.other_particles;
    for (; other_ < others.size() && others[other_] < end; ++other_)
      if (others[other_] >= begin)
        bonds_.take_other_pressure(others[other_]);
  }

  HWY_INLINE void dilatation(const PieceCursor &piece)
  {
    const typename Bonds::Offsets offsets(piece.segment());
    int done = piece.begin; // those before have flowed
    for_each_vector(piece.first, piece.begin, piece.end, [&](auto d, long i) HWY_ATTR {
      if constexpr (Bonds::inelastic)
        bonds_.strain(d, i, offsets, done);
      else
        bonds_.dilatation(d, i, offsets);
      done = int(i) + int(hn::Lanes(d));
    });
  }

  template <bool by_particle>
  HWY_INLINE void forces(const PieceCursor &piece)
  {
    const typename Bonds::Offsets offsets(piece.segment());
    int done = piece.begin;
    for_each_vector(piece.first, piece.begin, piece.end, [&](auto d, long i) HWY_ATTR {
      const int after = int(i) + int(hn::Lanes(d));
      const auto look = bonds_.template forces<by_particle>(d, i, offsets);
      if (HWY_UNLIKELY(!hn::AllFalse(d, look)))
        note<by_particle>(d, i, offsets, look, {std::max(int(i), done), after});
      done = after;
    });
  }

  /// Where there is something to look at: particles with bonds that could break.
  template <bool by_particle, typename D>
  HWY_INLINE void note(D d, long i, const typename Bonds::Offsets &offsets, hn::Mask<D> look,
                       const RowRange &range)
  {
    *sweep_.n_looked += range.end - range.begin;
    if (!std::isfinite(sweep_.constants.strength))
      return;
    auto found = look;
    if (!by_particle || sweep_.faces_too) {
      const auto could = bonds_.template could_break<by_particle>(d, i, offsets);
      found = by_particle ? hn::And(look, could) : could;
    }
    std::uint32_t lanes = lane_bits(d, found) >> (range.begin - int(i));
    for (int begin = range.begin; lanes != 0;) {
      int end = begin;
      for (; lanes & 1; lanes >>= 1)
        ++end;
      if (end > begin)
        sweep_.exceeded->push_back({begin, end});
      for (begin = end; lanes != 0 && !(lanes & 1); lanes >>= 1)
        ++begin;
    }
  }

  HWY_INLINE void energies(const PieceCursor &piece)
  {
    const typename Bonds::Offsets offsets(piece.segment());
    for_each_vector(piece.first, piece.begin, piece.end, [&](auto d, long i) HWY_ATTR {
      hn::StoreU(bonds_.energy(d, i, offsets), d, sweep_.energy + i);
    });
  }

  const RowSweep<dim> &sweep_;
  Bonds bonds_;
  PieceCursor dilated_;
  std::size_t turning_ = 0;        // range of the stage turn
  int turned_ = 0, forces_at_ = 0; // fronts of the stages
  std::size_t other_ = 0;          // next of the other particles
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
