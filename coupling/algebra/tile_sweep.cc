// Compiled once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "coupling/algebra/tile_sweep.cc"
#include "core/dispatch.h"

#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway wants it.
#include "coupling/algebra/tile_sweep.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace ligament::coupling::HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<double, lane_array_size>;
using Vector = hn::Vec<Lanes>;
// Independent sums hide the latency: each block waits for the one before.
constexpr int n_chains = 4;

/// sum -= rows `part` to `part` + lanes of tile * x
template <int columns>
HWY_INLINE void subtract_product(const Tile &tile, const LaneArray *x, int part,
                                 Vector (&sum)[columns][n_chains])
{
  const Lanes d;
#pragma GCC unroll 8
  for (int j = 0; j < lane_array_size; ++j) {
    const Vector t = hn::Load(d, tile.value[j] + part);
#pragma GCC unroll 3
    for (int c = 0; c < columns; ++c)
      sum[c][j % n_chains] = hn::NegMulAdd(t, hn::Set(d, x[c].value[j]), sum[c][j % n_chains]);
  }
}

template <int columns>
HWY_INLINE void set_zero(Vector (&sum)[columns][n_chains])
{
  for (auto &of_column : sum)
    for (auto &chain : of_column)
      chain = hn::Zero(Lanes());
}

HWY_INLINE Vector total(const Vector (&chain)[n_chains])
{
  return hn::Add(hn::Add(chain[0], chain[1]), hn::Add(chain[2], chain[3]));
}

template <int columns>
HWY_INLINE void sweep_columns(const TileSweep &sweep, LaneArray *x)
{
  const Lanes d;
  const int n_lanes = int(hn::Lanes(d));
  Vector sum[columns][n_chains];
  LaneArray minus[columns]; // -(x_k - sum T x)
  for (std::size_t k = 0; k < sweep.steps.size(); ++k) {
    const auto &step = sweep.steps[k];
    LaneArray *const own = x + columns * step.block;
    for (int part = 0; part < lane_array_size; part += n_lanes) {
      set_zero(sum);
      for (int l = step.begin; l < step.end; ++l)
        subtract_product(sweep.tiles[l], x + columns * sweep.other[l], part, sum);
      for (int c = 0; c < columns; ++c)
        hn::Store(hn::Neg(hn::Add(hn::Load(d, own[c].value + part), total(sum[c]))), d,
                  minus[c].value + part);
    }
    for (int part = 0; part < lane_array_size; part += n_lanes) {
      set_zero(sum);
      subtract_product(sweep.diagonal[k], minus, part, sum);
      for (int c = 0; c < columns; ++c)
        hn::Store(total(sum[c]), d, own[c].value + part);
    }
  }
}

void sweep_tiles_1(const TileSweep &sweep, LaneArray *x)
{
  sweep_columns<1>(sweep, x);
}
void sweep_tiles_2(const TileSweep &sweep, LaneArray *x)
{
  sweep_columns<2>(sweep, x);
}
void sweep_tiles_3(const TileSweep &sweep, LaneArray *x)
{
  sweep_columns<3>(sweep, x);
}
} // namespace ligament::coupling::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ligament::coupling
{
HWY_EXPORT(sweep_tiles_1);
HWY_EXPORT(sweep_tiles_2);
HWY_EXPORT(sweep_tiles_3);

void sweep_tiles(const TileSweep &sweep, int n_columns, LaneArray *x)
{
  if (n_columns == 1)
    HWY_DYNAMIC_DISPATCH(sweep_tiles_1)(sweep, x);
  else if (n_columns == 2)
    HWY_DYNAMIC_DISPATCH(sweep_tiles_2)(sweep, x);
  else
    HWY_DYNAMIC_DISPATCH(sweep_tiles_3)(sweep, x);
}
} // namespace ligament::coupling
#endif
