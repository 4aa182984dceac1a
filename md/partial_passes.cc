// Compiled once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "md/partial_passes.cc"
#include "core/dispatch.h"
#include "md/partial_kernel.h"

#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway wants it.
#include "md/table_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace ligament::md::HWY_NAMESPACE
{
/// Some pairs from number p on.
template <int dim>
struct LanePairs
{
  V x[dim], r2; // m, from i to j
  V tilts;      // J, with what embeddings add

  HWY_INLINE LanePairs(const PartialArrays &k, int p)
  {
    const D d;
    const Columns from = load_columns(k.atoms, 4, k.i + p), to = load_columns(k.atoms, 4, k.j + p);
    const V there[3] = {to.a, to.b, to.c}, here[3] = {from.a, from.b, from.c};
    for (int c = 0; c < dim; ++c) {
      x[c] = hn::Add(hn::Sub(there[c], here[c]), hn::LoadU(d, k.reference[c] + p));
      r2 = c == 0 ? hn::Mul(x[0], x[0]) : hn::MulAdd(x[c], x[c], r2);
    }
    tilts = hn::Add(hn::LoadU(d, k.tilts + p), hn::Add(from.d, to.d));
  }

  /// Squared distances less those at rest, m^2, with the digits of small displacements.
  HWY_INLINE V stretched(const PartialArrays &k, int p) const
  {
    const D d;
    const Columns from = load_columns(k.atoms, 4, k.i + p), to = load_columns(k.atoms, 4, k.j + p);
    const V there[3] = {to.a, to.b, to.c}, here[3] = {from.a, from.b, from.c};
    V sum = hn::Zero(d);
    for (int c = 0; c < dim; ++c) {
      const V moved = hn::Sub(there[c], here[c]);
      sum = hn::MulAdd(moved, hn::Add(x[c], hn::LoadU(d, k.reference[c] + p)), sum);
    }
    return sum;
  }

  HWY_INLINE bool are_far(const PartialArrays &k) const
  {
    return hn::AllTrue(D(), hn::Ge(r2, hn::Set(D(), k.cutoff2)));
  }

  HWY_INLINE void add_forces(const PartialArrays &k, int p, V tension) const // over length, N/m
  {
    const D d;
    HWY_ALIGN double f[dim][lanes];
    for (int c = 0; c < dim; ++c)
      hn::Store(hn::Mul(tension, x[c]), d, f[c]);
    for (int l = 0; l < lanes; ++l) {
      double *const at_i = k.force + 4 * std::ptrdiff_t(k.i[p + l]), *const at_j =
                                                                         k.force +
                                                                         4 * std::ptrdiff_t(
                                                                                 k.j[p + l]);
      for (int c = 0; c < dim; ++c) {
        at_i[c] += f[c][l];
        at_j[c] -= f[c][l];
      }
    }
  }
};

/// Functions of the distance; those of pairs out of range are 0, from the table's last piece.
struct LaneFunctions
{
  V pull, slope, density; // -phi'/r, f'/r, f

  template <bool embedded>
  HWY_INLINE void look_up(const PartialArrays &k, V r2)
  {
    const D d;
    const hn::Rebind<std::int32_t, D> di;
    const V step = hn::Set(d, k.inverse_step),
            least = hn::Set(d, 1e-12 / (k.inverse_step * k.inverse_step)),
            bounded = hn::Min(hn::Max(r2, least), hn::Set(d, k.beyond2)),
            inverse = inverse_root(bounded), place = hn::Mul(hn::Mul(bounded, inverse), step),
            whole = hn::Trunc(place), t = hn::Sub(place, whole);
    HWY_ALIGN std::int32_t piece[lanes];
    hn::Store(hn::DemoteTo(di, whole), di, piece);
    pull = hn::Mul(parabola(load_columns(k.table[0].pull, 8, piece), t), inverse);
    if constexpr (embedded) {
      const ValueSlope f = cubic(load_columns(k.table[0].density, 8, piece), t);
      density = f.value;
      slope = hn::Mul(hn::Mul(f.slope, step), inverse);
    }
  }
};

template <int dim>
void first_pass(const PartialArrays &k)
{
  const D d;
  for (int p = 0; p < k.n_pairs; p += lanes) {
    const LanePairs<dim> pairs(k, p);
    LaneFunctions f;
    f.pull = f.slope = hn::Zero(d);
    if (!pairs.are_far(k)) {
      f.template look_up<true>(k, pairs.r2);
      HWY_ALIGN double density[lanes];
      hn::Store(f.density, d, density);
      for (int l = 0; l < lanes; ++l) {
        k.density[k.i[p + l]] += density[l];
        k.density[k.j[p + l]] += density[l];
      }
    }
    hn::StoreU(f.pull, d, k.pull + p);
    hn::StoreU(f.slope, d, k.slope + p);
  }
}

template <int dim>
void second_pass(const PartialArrays &k)
{
  const D d;
  for (int p = 0; p < k.n_pairs; p += lanes) {
    const LanePairs<dim> pairs(k, p);
    if (pairs.are_far(k))
      continue;
    pairs.add_forces(k, p,
                     hn::MulSub(pairs.tilts, hn::LoadU(d, k.slope + p),
                                hn::Mul(hn::LoadU(d, k.share + p), hn::LoadU(d, k.pull + p))));
  }
}

template <int dim>
void pair_pass(const PartialArrays &k)
{
  const D d;
  for (int p = 0; p < k.n_pairs; p += lanes) {
    const LanePairs<dim> pairs(k, p);
    if (pairs.are_far(k))
      continue;
    LaneFunctions f;
    f.template look_up<false>(k, pairs.r2);
    pairs.add_forces(k, p, hn::Neg(hn::Mul(hn::LoadU(d, k.share + p), f.pull)));
  }
}

/// What functions of the distance have gained between two places of the table, in its steps: within
/// a piece as a product with the way, which keeps the digits of a small one.
struct LaneGains
{
  V from, to, from_whole, to_whole; // t in the pieces; their numbers
  HWY_ALIGN std::int32_t from_piece[lanes], to_piece[lanes];

  HWY_INLINE LaneGains(V first, V last)
  {
    const hn::Rebind<std::int32_t, D> di;
    from_whole = hn::Trunc(first);
    to_whole = hn::Trunc(last);
    from = hn::Sub(first, from_whole);
    to = hn::Sub(last, to_whole);
    hn::Store(hn::DemoteTo(di, from_whole), di, from_piece);
    hn::Store(hn::DemoteTo(di, to_whole), di, to_piece);
  }

  /// Of a cubic a + t (b + t (c + t d)) per piece.
  HWY_INLINE V of(const Columns &first, const Columns &last, V way) const
  {
    const V sum = hn::Add(from, to), squares = hn::MulAdd(from, sum, hn::Mul(to, to)),
            within = hn::Mul(way, hn::MulAdd(last.d, squares, hn::MulAdd(last.c, sum, last.b))),
            across = hn::Sub(cubic(last, to).value, cubic(first, from).value);
    return hn::IfThenElse(hn::Eq(from_whole, to_whole), within, across);
  }
};

template <int dim, bool embedded>
void change_pass(const PartialArrays &k)
{
  const D d;
  V energy = hn::Zero(d);
  for (int p = 0; p < k.n_pairs; p += lanes) {
    const LanePairs<dim> pairs(k, p);
    const V rest = hn::LoadU(d, k.rest + p), step = hn::Set(d, k.inverse_step),
            end = hn::Set(d, k.end);
    const V longer = hn::Mul(
        step, hn::Div(pairs.stretched(k, p), hn::Add(rest, hn::Sqrt(pairs.r2)))); // all digits
    const V at_rest = hn::Mul(rest, step), now = hn::Add(at_rest, longer),
            first = hn::Min(at_rest, end), last = hn::Min(now, end),
            way = hn::IfThenElse(hn::Lt(hn::Max(at_rest, now), end), longer, hn::Sub(last, first));
    if (hn::AllTrue(d, hn::Eq(way, hn::Zero(d))))
      continue;
    const LaneGains gains(first, last);
    const V pair =
        gains.of(pair_cubic(load_columns(k.table[0].pull, 8, gains.from_piece), k.inverse_step),
                 pair_cubic(load_columns(k.table[0].pull, 8, gains.to_piece), k.inverse_step), way);
    energy = hn::MulAdd(hn::LoadU(d, k.share + p), pair, energy);
    if constexpr (embedded) {
      const V gain = gains.of(load_columns(k.table[0].density, 8, gains.from_piece),
                              load_columns(k.table[0].density, 8, gains.to_piece), way);
      energy = hn::MulAdd(hn::LoadU(d, k.tilts + p), gain, energy);
      HWY_ALIGN double denser[lanes];
      hn::Store(gain, d, denser);
      for (int l = 0; l < lanes; ++l) {
        k.density[k.i[p + l]] += denser[l];
        k.density[k.j[p + l]] += denser[l];
      }
    }
  }
  hn::StoreU(energy, d, k.energy);
}

PartialPasses choose_partial_2d()
{
  return {&first_pass<2>, &second_pass<2>, &pair_pass<2>, &change_pass<2, true>,
          &change_pass<2, false>};
}
PartialPasses choose_partial_3d()
{
  return {&first_pass<3>, &second_pass<3>, &pair_pass<3>, &change_pass<3, true>,
          &change_pass<3, false>};
}
} // namespace ligament::md::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ligament::md
{
HWY_EXPORT(choose_partial_2d);
HWY_EXPORT(choose_partial_3d);

template <>
PartialPasses partial_passes<2>()
{
  return HWY_DYNAMIC_DISPATCH(choose_partial_2d)();
}
template <>
PartialPasses partial_passes<3>()
{
  return HWY_DYNAMIC_DISPATCH(choose_partial_3d)();
}
} // namespace ligament::md
#endif
