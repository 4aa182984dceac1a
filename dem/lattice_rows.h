// The loops over rows that both dimensions share; what a bond answers comes in as a policy `Bonds`.
#pragma once

#include "dem/dispatch.h"
#include "dem/lattice_kernel.h"

#include <algorithm>
#include <utility>

namespace ligament::dem
{
/// 1 where bond k of the particle carries, 0 where it doesn't.
LIGAMENT_INLINE double weight(std::uint32_t mask, int k)
{
  return double(int(mask >> k & 1));
}

/// Indices and weights of the two neighbours along one direction.
struct Neighbours
{
  long forward, backward;
  double w_forward, w_backward;
};

template <int dim, int n_dir>
struct RowConstants
{
  std::array<DirectionConstants<dim>, n_dir> direction;
  std::array<long, n_dir> forward, backward;

  LIGAMENT_INLINE RowConstants(const RowSweep<dim> &sweep, const RowSegment &segment)
  {
    for (int k = 0; k < n_dir; ++k) {
      direction[k] = (*sweep.directions)[k];
      forward[k] = segment.forward[k];
      backward[k] = segment.backward[k];
    }
  }
};

template <typename Bonds, bool full, int dim, int n_dir, std::size_t... k>
LIGAMENT_INLINE double
sum_dilatation(const LatticeArrays<dim> &a, const RowConstants<dim, n_dir> &row,
               const typename Bonds::Own &own, long i, std::index_sequence<k...>)
{
  const std::uint32_t mask = a.mask[i];
  double sum = 0;
  ((sum += Bonds::template dilatation<full>(a, row.direction[k], own,
                                            Neighbours{i + row.forward[k], i + row.backward[k],
                                                       weight(mask, k), weight(mask, n_dir + k)})),
   ...);
  return sum;
}

template <typename Bonds, bool full, int dim, int n_dir, std::size_t... k>
LIGAMENT_INLINE void sum_forces(const LatticeArrays<dim> &a, const RowConstants<dim, n_dir> &row,
                                const typename Bonds::Own &own, long i, typename Bonds::Sum &sum,
                                std::index_sequence<k...>)
{
  const std::uint32_t mask = a.mask[i];
  (Bonds::template force<full>(a, row.direction[k], own,
                               Neighbours{i + row.forward[k], i + row.backward[k], weight(mask, k),
                                          weight(mask, n_dir + k)},
                               sum),
   ...);
}

template <typename Bonds, bool full, int dim, int n_dir>
LIGAMENT_INLINE void dilatation_range(const LatticeArrays<dim> &arrays,
                                      const RowConstants<dim, n_dir> &constants, long begin,
                                      long end)
{
  const LatticeArrays<dim> a = arrays;
  const RowConstants<dim, n_dir> row = constants;
#pragma GCC ivdep
  for (long i = begin; i < end; ++i)
    a.pressure[i] =
        a.lambda_per_volume[i] *
        sum_dilatation<Bonds, full>(a, row, Bonds::own(a, i), i, std::make_index_sequence<n_dir>());
}

template <typename Bonds, bool full, int dim, int n_dir>
LIGAMENT_INLINE bool force_range(const LatticeArrays<dim> &arrays,
                                 const RowConstants<dim, n_dir> &constants, long begin, long end)
{
  const LatticeArrays<dim> a = arrays;
  const RowConstants<dim, n_dir> row = constants;
  int exceeded = 0;
#pragma GCC ivdep
  for (long i = begin; i < end; ++i) {
    const auto own = Bonds::own(a, i);
    typename Bonds::Sum sum;
    sum_forces<Bonds, full>(a, row, own, i, sum, std::make_index_sequence<n_dir>());
    Bonds::store(a, own, i, sum);
    exceeded |= sum.exceeded;
  }
  return exceeded != 0;
}

/// Calls range(begin, end, segment, full) for pieces of the segments short enough for the nearest
/// cache; full: every bond of every particle in it carries.
template <int n_dir, typename Range>
LIGAMENT_INLINE void for_each_range(const std::uint32_t *mask,
                                    const std::vector<RowSegment> &segments, Range &&range)
{
  constexpr int longest = 512;
  constexpr std::uint32_t all_bonds = (1u << 2 * n_dir) - 1;
  for (const RowSegment &segment : segments)
    for (int begin = segment.begin; begin < segment.end; begin += longest) {
      const int end = std::min(begin + longest, segment.end);
      std::uint32_t common = ~0u;
      for (int i = begin; i < end; ++i)
        common &= mask[i];
      range(begin, end, segment, (common & all_bonds) == all_bonds);
    }
}

template <typename Bonds, int n_dir, int dim>
LIGAMENT_INLINE void sweep_dilatation(const RowSweep<dim> &sweep)
{
  for_each_range<n_dir>(
      sweep.arrays.mask, *sweep.segments,
      [&](int begin, int end, const RowSegment &segment, bool full) __attribute__((always_inline)) {
        const RowConstants<dim, n_dir> row(sweep, segment);
        if (full)
          dilatation_range<Bonds, true>(sweep.arrays, row, begin, end);
        else
          dilatation_range<Bonds, false>(sweep.arrays, row, begin, end);
      });
}

template <typename Bonds, int n_dir, int dim>
LIGAMENT_INLINE void sweep_forces(const RowSweep<dim> &sweep)
{
  for_each_range<n_dir>(
      sweep.arrays.mask, *sweep.segments,
      [&](int begin, int end, const RowSegment &segment, bool full) __attribute__((always_inline)) {
        const RowConstants<dim, n_dir> row(sweep, segment);
        const bool exceeded = full ? force_range<Bonds, true>(sweep.arrays, row, begin, end)
                                   : force_range<Bonds, false>(sweep.arrays, row, begin, end);
        if (exceeded)
          sweep.exceeded->push_back({begin, end});
      });
}
} // namespace ligament::dem
