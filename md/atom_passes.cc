// Compiled once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "md/atom_passes.cc"
#include "core/dispatch.h"
#include "md/atom_kernel.h"

#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway wants it.
#include "md/table_lanes.h"

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace ligament::md::HWY_NAMESPACE
{
#if HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128 // plain code: lane by lane
void store_rows(V x, V y, V z, double *rows)
{
  const D d;
  HWY_ALIGN double columns[3][lanes];
  hn::Store(x, d, columns[0]);
  hn::Store(y, d, columns[1]);
  hn::Store(z, d, columns[2]);
  for (int lane = 0; lane < lanes; ++lane)
    for (int c = 0; c < 4; ++c)
      rows[4 * lane + c] = c < 3 ? columns[c][lane] : 0;
}

void add_record(const double *from, double *to)
{
  for (int c = 0; c < 4; ++c)
    to[c] += from[c];
}

/// Stores the lanes of a mask one behind the other.
struct Packing
{
  hn::Mask<D> mask;

  explicit Packing(hn::Mask<D> m) : mask(m) {}
  void store(V v, double *to) const
  {
    const D d;
    HWY_ALIGN double lane[lanes];
    hn::Store(v, d, lane);
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, mask, bits);
    for (int k = 0; k < lanes; ++k)
      if (bits[0] >> k & 1)
        *to++ = lane[k];
  }
  void store(const std::int32_t *from, std::int32_t *to) const
  {
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(D(), mask, bits);
    for (int k = 0; k < lanes; ++k)
      if (bits[0] >> k & 1)
        *to++ = from[k];
  }
};
#else
/// Stores x, y, z, 0 of each lane as four numbers in turn.
HWY_INLINE void store_rows(V x, V y, V z, double *rows)
{
  const D d;
  // [x y | z 0] of lanes 0 and 4, 1 and 5, ...
  const V zero = hn::Zero(d), xy_even = hn::InterleaveLower(d, x, y),
          xy_odd = hn::InterleaveUpper(d, x, y), z_even = hn::InterleaveLower(d, z, zero),
          z_odd = hn::InterleaveUpper(d, z, zero);
  const V row[4] = {hn::OddEvenBlocks(hn::SwapAdjacentBlocks(z_even), xy_even),
                    hn::OddEvenBlocks(hn::SwapAdjacentBlocks(z_odd), xy_odd),
                    hn::OddEvenBlocks(z_even, hn::SwapAdjacentBlocks(xy_even)),
                    hn::OddEvenBlocks(z_odd, hn::SwapAdjacentBlocks(xy_odd))};
  for (int r = 0; r < 4; ++r)
    if constexpr (lanes == 8) {
      const hn::Half<D> half;
      hn::StoreU(hn::LowerHalf(half, row[r]), half, rows + 4 * r);
      hn::StoreU(hn::UpperHalf(half, row[r]), half, rows + 4 * (r + 4));
    } else
      hn::StoreU(row[r], d, rows + 4 * r);
}

#if HWY_TARGET == HWY_AVX3
struct Packing
{
  hn::Mask<D> mask;

  HWY_INLINE explicit Packing(hn::Mask<D> m) : mask(m) {}
  HWY_INLINE void store(V v, double *to) const
  {
    hn::StoreU(V{_mm512_maskz_compress_pd(mask.raw, v.raw)}, D(), to);
  }
  /// Loads whole numbers, one per lane.
  HWY_INLINE void store(const std::int32_t *from, std::int32_t *to) const
  {
    const hn::Rebind<std::int32_t, D> di;
    hn::StoreU(
        hn::VFromD<decltype(di)>{_mm256_maskz_compress_epi32(mask.raw, hn::LoadU(di, from).raw)},
        di, to);
  }
};
#else
/// Lanes that each of the masks of four keeps, and then others.
alignas(32) const std::int64_t kept_lanes[16][4] = {
    {0, 1, 2, 3}, {0, 1, 2, 3}, {1, 0, 2, 3}, {0, 1, 2, 3}, {2, 0, 1, 3}, {0, 2, 1, 3},
    {1, 2, 0, 3}, {0, 1, 2, 3}, {3, 0, 1, 2}, {0, 3, 1, 2}, {1, 3, 0, 2}, {0, 1, 3, 2},
    {2, 3, 0, 1}, {0, 2, 3, 1}, {1, 2, 3, 0}, {0, 1, 2, 3}};

// Highway's own Compress copies its table to the stack in every call (1.0.3 with gcc 12).
struct Packing
{
  const std::int64_t *kept;
  decltype(hn::IndicesFromVec(D(), hn::Zero(hn::RebindToSigned<D>()))) indices;

  HWY_INLINE explicit Packing(hn::Mask<D> m)
      : kept(of(m)), indices(hn::IndicesFromVec(D(), hn::Load(hn::RebindToSigned<D>(), kept)))
  {
  }
  static HWY_INLINE const std::int64_t *of(hn::Mask<D> mask)
  {
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(D(), mask, bits);
    return kept_lanes[bits[0]];
  }
  HWY_INLINE void store(V v, double *to) const
  {
    hn::StoreU(hn::TableLookupLanes(v, indices), D(), to);
  }
  HWY_INLINE void store(const std::int32_t *from, std::int32_t *to) const
  {
    for (int lane = 0; lane < 4; ++lane)
      to[lane] = from[kept[lane]];
  }
};
#endif

HWY_INLINE void add_record(const double *from, double *to)
{
  const hn::CappedTag<double, 4> d;
  hn::Store(hn::Add(hn::Load(d, to), hn::LoadU(d, from)), d, to);
}
#endif

/// Room for so many pairs.
void widen(PairBuffer &q, std::size_t room, bool has_several)
{
  if (q.pull.size() >= room)
    return;
  q.place.resize(room);
  q.other.resize(room);
  q.slope.resize(room);
  q.pull.resize(room);
  if (has_several)
    q.other_slope.resize(room);
}

/// Pairs of the block in range go to the buffer, squared distances to its `pull`.
int find_in_range(const KernelArrays &k, const SlotBlock &block, PairBuffer &q)
{
  const D d;
  widen(q, std::size_t(k.begin[block.last] - k.begin[block.first]) + 2 * lanes, k.row);
  q.row_end.resize(block.last - block.first);
  double *const squares = q.pull.data();
  std::int32_t *const places = q.place.data();
  const V limit = hn::Set(d, k.cutoff2);
  int n = 0;
  for (int s = block.first; s < block.last; ++s) {
    const V x = hn::Set(d, k.records[s].x), y = hn::Set(d, k.records[s].y),
            z = hn::Set(d, k.records[s].z);
    const int end = k.begin[s + 1];
    for (int m = k.begin[s]; m < end; m += lanes) {
      const Columns p = load_columns(&k.records[0].x, 4, k.neighbours + m);
      const V dx = hn::Sub(p.a, x), dy = hn::Sub(p.b, y), dz = hn::Sub(p.c, z),
              r2 = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
      auto near = hn::Lt(r2, limit);
      if (m + lanes > end)
        near = hn::And(near, hn::FirstN(d, std::size_t(end - m)));
      const Packing packing(near);
      packing.store(r2, squares + n);
      packing.store(k.neighbours + m, places + n);
      n += int(hn::CountTrue(d, near));
    }
    q.row_end[s - block.first] = n;
  }
  for (int m = n; m < n + lanes; ++m) { // lanes without a pair, far out
    squares[m] = k.cutoff2;
    places[m] = 0;
  }
  for (int m = 0; k.slot_of_image && m < n; ++m)
    q.other[m] = q.place[m] < k.n_atoms ? q.place[m] : k.slot_of_image[q.place[m] - k.n_atoms];
  return n;
}

/// The slots of the others: their places, but for images.
const std::int32_t *others(const KernelArrays &k, const PairBuffer &q)
{
  return k.slot_of_image ? q.other.data() : q.place.data();
}

/// Where the tables of pairs begin: for what the other is to the slot, and the slot to the other.
void find_tables(const KernelArrays &k, const SlotBlock &block, const PairBuffer &q, int *straight,
                 int *reverse)
{
  const std::int32_t *const other = others(k, q);
  int m = 0;
  for (int s = block.first; s < block.last; ++s)
    for (const int end = q.row_end[s - block.first]; m < end; ++m) {
      straight[m] = k.row[s] + k.column[other[m]];
      reverse[m] = k.row[other[m]] + k.column[s];
    }
  std::fill(straight + m, straight + m + lanes, 0);
  std::fill(reverse + m, reverse + m + lanes, 0);
}

/// Numbers of the scratch that a block's pairs take, in whole vectors.
int rounded(int n)
{
  return (n + 2 * lanes - 1) / lanes * lanes;
}

template <bool has_several, bool sums_energy>
void first_pass_of(const KernelArrays &k, const SlotBlock &block, PairBuffer &q)
{
  const D d;
  const hn::Rebind<std::int32_t, D> di;
  const int n = find_in_range(k, block, q);
  double *const slope = q.slope.data(), *const pull = q.pull.data(), *const values = k.scratch,
                *const other_values = has_several ? values + rounded(n) : values;
  int *const straight = reinterpret_cast<int *>(values + 2 * rounded(n)), *const reverse =
                                                                              straight + rounded(n);
  if (has_several)
    find_tables(k, block, q, straight, reverse);
  const V inverse_step = hn::Set(d, k.inverse_step),
          least = hn::Set(d, 1e-12 / (k.inverse_step * k.inverse_step));
  HWY_ALIGN std::int32_t piece[lanes], reverse_piece[lanes];
  V energy = hn::Zero(d);
  for (int m = 0; m < n; m += lanes) {
    // Atoms at the same place have no direction: their force is 0.
    const V r2 = hn::Max(hn::LoadU(d, pull + m), least), inverse = inverse_root(r2),
            place = hn::Mul(hn::Mul(r2, inverse), inverse_step);
    auto whole = hn::DemoteTo(di, place); // towards 0
    const V t = hn::Sub(place, hn::PromoteTo(d, whole));
    if constexpr (has_several) {
      hn::Store(hn::Add(whole, hn::LoadU(di, reverse + m)), di, reverse_piece);
      const ValueSlope f = cubic(load_columns(k.table[0].density, 8, reverse_piece), t);
      hn::StoreU(f.value, d, other_values + m);
      hn::StoreU(hn::Mul(f.slope, inverse), d, q.other_slope.data() + m);
      whole = hn::Add(whole, hn::LoadU(di, straight + m));
    }
    hn::Store(whole, di, piece);
    const ValueSlope f = cubic(load_columns(k.table[0].density, 8, piece), t);
    const Columns pair = load_columns(k.table[0].pull, 8, piece);
    const V p = parabola(pair, t);
    if constexpr (sums_energy) // lanes without a pair are in the piece of zeros
      energy = hn::Add(energy, pair_energy(pair, t, k.inverse_step));
    hn::StoreU(f.value, d, values + m);
    hn::StoreU(hn::Mul(f.slope, inverse), d, slope + m);
    hn::StoreU(hn::Mul(p, inverse), d, pull + m);
  }
  if constexpr (sums_energy)
    q.energy = hn::GetLane(hn::SumOfLanes(d, energy));
  const std::int32_t *const other = others(k, q);
  int m = 0;
  for (int s = block.first; s < block.last; ++s) {
    double sum = 0;
    for (const int end = q.row_end[s - block.first]; m < end; ++m) {
      sum += values[m];
      k.density[other[m]] += other_values[m];
    }
    k.density[s] += sum;
  }
}

// Vectors between atoms are found again: to keep them would take more time than that.
template <bool has_several>
void second_pass_of(const KernelArrays &k, const SlotBlock &block, PairBuffer &q)
{
  const D d;
  const std::int32_t *const other = others(k, q), *const places = q.place.data();
  const double *const own_slope = q.slope.data(), *const pull = q.pull.data(),
                      *const other_slope = has_several ? q.other_slope.data() : own_slope;
  double *const rows = k.scratch;
  int m = 0;
  for (int s = block.first; s < block.last; ++s) {
    const V x = hn::Set(d, k.records[s].x), y = hn::Set(d, k.records[s].y),
            z = hn::Set(d, k.records[s].z), slope = hn::Set(d, k.records[s].extra);
    // What the last vector has of the next row is overwritten by that.
    for (const int end = q.row_end[s - block.first]; m < end; m += lanes) {
      const Columns p = load_columns(&k.records[0].x, 4, places + m);
      const V at_other = p.d, f = hn::LoadU(d, own_slope + m),
              c = has_several ? hn::MulAdd(slope, f,
                                           hn::MulAdd(at_other, hn::LoadU(d, other_slope + m),
                                                      hn::LoadU(d, pull + m)))
                              : hn::MulAdd(hn::Add(slope, at_other), f, hn::LoadU(d, pull + m));
      store_rows(hn::Mul(c, hn::Sub(p.a, x)), hn::Mul(c, hn::Sub(p.b, y)),
                 hn::Mul(c, hn::Sub(p.c, z)), rows + 4 * m);
    }
    m = q.row_end[s - block.first];
  }
  m = 0;
  for (int s = block.first; s < block.last; ++s) {
    HWY_ALIGN double sum[4] = {};
    for (const int end = q.row_end[s - block.first]; m < end; ++m) {
      add_record(rows + 4 * m, &k.force[other[m]].x);
      add_record(rows + 4 * m, sum);
    }
    for (int c = 0; c < 4; ++c)
      (&k.force[s].x)[c] -= sum[c];
  }
}

void first_pass(const KernelArrays &k, const SlotBlock &block, PairBuffer &q)
{
  k.row ? first_pass_of<true, false>(k, block, q) : first_pass_of<false, false>(k, block, q);
}

void energy_pass(const KernelArrays &k, const SlotBlock &block, PairBuffer &q)
{
  k.row ? first_pass_of<true, true>(k, block, q) : first_pass_of<false, true>(k, block, q);
}

void second_pass(const KernelArrays &k, const SlotBlock &block, PairBuffer &q)
{
  k.row ? second_pass_of<true>(k, block, q) : second_pass_of<false>(k, block, q);
}

KernelPasses choose_passes()
{
  return {&first_pass, &second_pass, &energy_pass};
}
} // namespace ligament::md::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ligament::md
{
HWY_EXPORT(choose_passes);

KernelPasses kernel_passes()
{
  return HWY_DYNAMIC_DISPATCH(choose_passes)();
}
} // namespace ligament::md
#endif
