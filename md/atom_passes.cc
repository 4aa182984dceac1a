// Compiled once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "md/atom_passes.cc"
#include "core/dispatch.h"
#include "md/atom_kernel.h"

#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway wants it.
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
Columns load_columns(const double *first, int stride, const Index *index)
{
  const D d;
  HWY_ALIGN double columns[4][lanes];
  for (int lane = 0; lane < lanes; ++lane)
    for (int c = 0; c < 4; ++c)
      columns[c][lane] = first[std::ptrdiff_t(stride) * index[lane] + c];
  return {hn::Load(d, columns[0]), hn::Load(d, columns[1]), hn::Load(d, columns[2]),
          hn::Load(d, columns[3])};
}

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
};
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
  const auto row = [&](int lane) {
    const double *const at = first + std::ptrdiff_t(stride) * index[lane];
    if constexpr (lanes == 8) {
      const hn::Half<D> half;
      return hn::Combine(d,
                         hn::Load(half, first + std::ptrdiff_t(stride) * index[lane + lanes / 2]),
                         hn::Load(half, at));
    } else
      return hn::Load(d, at);
  };
  return transposed(row(0), row(1), row(2), row(3));
}

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
  decltype(hn::IndicesFromVec(D(), hn::Zero(hn::RebindToSigned<D>()))) indices;

  HWY_INLINE explicit Packing(hn::Mask<D> m) : indices(of(m)) {}
  static HWY_INLINE decltype(indices) of(hn::Mask<D> mask)
  {
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(D(), mask, bits);
    return hn::IndicesFromVec(D(), hn::Load(hn::RebindToSigned<D>(), kept_lanes[bits[0]]));
  }
  HWY_INLINE void store(V v, double *to) const
  {
    hn::StoreU(hn::TableLookupLanes(v, indices), D(), to);
  }
};
#endif

HWY_INLINE void add_record(const double *from, double *to)
{
  const hn::CappedTag<double, 4> d;
  hn::Store(hn::Add(hn::Load(d, to), hn::LoadU(d, from)), d, to);
}
#endif

/// Pairs of the block in range go to the buffer, squared distances to its `pair`, the numbers of
/// the others to its `density`.
int find_in_range(const KernelArrays &k, const SlotBlock &block, PairBuffer &q)
{
  const D d;
  const hn::Rebind<std::int32_t, D> di;
  const std::size_t room = k.begin[block.last] - k.begin[block.first] + 2 * lanes;
  if (q.density.size() < room) {
    q.place.resize(room);
    q.other.resize(room);
    q.density.resize(room);
    q.pair.resize(room);
  }
  q.row_end.resize(block.last - block.first);
  double *const squares = q.pair.data(), *const places = q.density.data();
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
      packing.store(hn::PromoteTo(d, hn::LoadU(di, k.neighbours + m)), places + n);
      n += int(hn::CountTrue(d, near));
    }
    q.row_end[s - block.first] = n;
  }
  for (int m = n; m < n + lanes; ++m) { // lanes without a pair, far out
    squares[m] = k.cutoff2;
    places[m] = 0;
  }
  return n;
}

/// The slots of the others: their places, but for images.
const std::int32_t *others(const KernelArrays &k, const PairBuffer &q)
{
  return k.slot_of_image ? q.other.data() : q.place.data();
}

void first_pass(const KernelArrays &k, const SlotBlock &block, PairBuffer &q)
{
  const D d;
  const hn::Rebind<std::int32_t, D> di;
  const int n = find_in_range(k, block, q);
  double *const density = q.density.data(), *const pair = q.pair.data();
  for (int m = 0; m < n + lanes; m += lanes)
    hn::StoreU(hn::DemoteTo(di, hn::LoadU(d, density + m)), di, q.place.data() + m);
  for (int m = 0; k.slot_of_image && m < n; ++m)
    q.other[m] = q.place[m] < k.n_atoms ? q.place[m] : k.slot_of_image[q.place[m] - k.n_atoms];
  const V inverse_step = hn::Set(d, k.inverse_step), one = hn::Set(d, 1.), two = hn::Set(d, 2.),
          three = hn::Set(d, 3.), least = hn::Set(d, 1e-12 / (k.inverse_step * k.inverse_step));
  HWY_ALIGN std::int32_t piece[lanes];
  for (int m = 0; m < n; m += lanes) {
    // Atoms at the same place have no direction: their force is 0.
    const V r2 = hn::Max(hn::LoadU(d, pair + m), least), inverse = hn::Div(one, hn::Sqrt(r2)),
            place = hn::Mul(hn::Mul(r2, inverse), inverse_step);
    const auto whole = hn::DemoteTo(di, place); // towards 0
    hn::Store(whole, di, piece);
    const V t = hn::Sub(place, hn::PromoteTo(d, whole));
    const Columns f = load_columns(k.table[0].density, 8, piece),
                  p = load_columns(k.table[0].pair, 8, piece);
    const V value = hn::MulAdd(hn::MulAdd(hn::MulAdd(f.d, t, f.c), t, f.b), t, f.a);
    const auto slope = [&](const Columns &c) {
      return hn::MulAdd(hn::MulAdd(hn::Mul(c.d, three), t, hn::Mul(two, c.c)), t, c.b);
    };
    const V scale = hn::Neg(hn::Mul(inverse, inverse_step));
    hn::StoreU(value, d, k.scratch + m);
    hn::StoreU(hn::Mul(slope(f), scale), d, density + m);
    hn::StoreU(hn::Mul(slope(p), scale), d, pair + m);
  }
  const std::int32_t *const other = others(k, q);
  int m = 0;
  for (int s = block.first; s < block.last; ++s) {
    double sum = 0;
    for (const int end = q.row_end[s - block.first]; m < end; ++m) {
      sum += k.scratch[m];
      k.density[other[m]] += k.scratch[m];
    }
    k.density[s] += sum;
  }
}

// Vectors between atoms are found again: to keep them would take more time than that.
void second_pass(const KernelArrays &k, const SlotBlock &block, PairBuffer &q)
{
  const D d;
  const std::int32_t *const other = others(k, q), *const places = q.place.data();
  const double *const density = q.density.data(), *const pair = q.pair.data();
  const int n = q.row_end.back();
  double *const slopes = k.scratch, *const rows = k.scratch + (n + lanes + 3) / 4 * 4; // aligned
  for (int m = 0; m < n; ++m)
    slopes[m] = k.slope[other[m]];
  int m = 0;
  for (int s = block.first; s < block.last; ++s) {
    const V x = hn::Set(d, k.records[s].x), y = hn::Set(d, k.records[s].y),
            z = hn::Set(d, k.records[s].z), slope = hn::Set(d, k.slope[s]);
    // What the last vector has of the next row is overwritten by that.
    for (const int end = q.row_end[s - block.first]; m < end; m += lanes) {
      const Columns p = load_columns(&k.records[0].x, 4, places + m);
      const V c = hn::MulAdd(hn::Add(slope, hn::LoadU(d, slopes + m)), hn::LoadU(d, density + m),
                             hn::LoadU(d, pair + m));
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

KernelPasses choose_passes()
{
  return {&first_pass, &second_pass};
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
