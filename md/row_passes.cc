// Compiled once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "md/row_passes.cc"
#include "core/dispatch.h"
#include "md/row_kernel.h"

#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway wants it.
#include "md/table_lanes.h"

#include <algorithm>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace ligament::md::HWY_NAMESPACE
{
/// A bond of all atoms of a vector.
template <int dim>
struct LaneBond
{
  V x[dim]; // m, from the atoms to their neighbours

  HWY_INLINE LaneBond(const RowArrays &k, const RowTask &task, int b, int s, const V *own)
  {
    const D d;
    const int j = s + task.shift[b];
    for (int c = 0; c < dim; ++c)
      x[c] = hn::Add(hn::Sub(hn::LoadU(d, k.displacement[c] + j), own[c]),
                     hn::Set(d, k.bonds[b * dim + c]));
  }

  HWY_INLINE V squared_length() const
  {
    V sum = hn::Mul(x[0], x[0]);
    for (int c = 1; c < dim; ++c)
      sum = hn::MulAdd(x[c], x[c], sum);
    return sum;
  }
};

/// What a bond adds to densities, (df/dt)/r and -phi'/r.
struct LaneJets
{
  V density, slope, pull;
};

/// In a crystal that is hardly disturbed all lanes look up a few neighbouring intervals: their
/// numbers come by loads of a vector and permutations. Bonds out of range are taken as just beyond
/// the cut-off, where a piece of zeros lies: what they add is 0, exactly.
template <bool embedded, bool is_tail>
HWY_INLINE LaneJets look_up(const RowArrays &k, V r2, hn::Mask<D> live)
{
  const D d;
  const hn::Rebind<std::int32_t, D> di;
  const hn::RebindToSigned<D> dl;
  // Atoms at the same place have no direction: their force is 0.
  const V zero = hn::Zero(d), least = hn::Set(d, 1e-12 / (k.inverse_step * k.inverse_step)),
          bounded = hn::Min(hn::Max(r2, least), hn::Set(d, k.beyond2)),
          inverse = inverse_root(bounded),
          place = hn::Mul(hn::Mul(bounded, inverse), hn::Set(d, k.inverse_step)),
          whole = hn::Trunc(place), t = hn::Sub(place, whole);
  const int base = std::max(int(hn::GetLane(whole)) - lanes / 2, 0);
  const V from_base = hn::Sub(whole, hn::Set(d, double(base)));
  auto is_near = hn::And(hn::Ge(from_base, zero), hn::Lt(from_base, hn::Set(d, double(lanes))));
  if constexpr (is_tail)
    is_near = hn::Or(is_near, hn::Not(live));
  LaneJets jets;
  jets.density = jets.slope = zero;
  auto is_same = hn::Eq(whole, hn::Set(d, hn::GetLane(whole)));
  if constexpr (is_tail)
    is_same = hn::Or(is_same, hn::Not(live));
  if (hn::AllTrue(d, is_same)) {
    const PairPiece &p = k.table[int(hn::GetLane(whole))];
    const auto columns = [&](const double *c) HWY_ATTR {
      return Columns{hn::Set(d, c[0]), hn::Set(d, c[1]), hn::Set(d, c[2]), hn::Set(d, c[3])};
    };
    if constexpr (embedded) {
      const ValueSlope f = cubic(columns(p.density), t);
      jets.density = f.value;
      jets.slope = f.slope;
    }
    jets.pull = parabola(columns(p.pull), t);
  } else if (hn::AllTrue(d, is_near)) {
    const auto among = hn::And(hn::PromoteTo(dl, hn::DemoteTo(di, from_base)),
                               hn::Set(dl, lanes - 1)); // dead lanes, too
    const auto indices = hn::IndicesFromVec(d, among);
    const double *const first = k.columns + base;
    const auto number = [&](int c) HWY_ATTR {
      return hn::TableLookupLanes(hn::LoadU(d, first + std::ptrdiff_t(c) * k.column_size), indices);
    };
    if constexpr (embedded) {
      const ValueSlope f = cubic({number(3), number(4), number(5), number(6)}, t);
      jets.density = f.value;
      jets.slope = f.slope;
    }
    jets.pull = parabola({number(0), number(1), number(2), zero}, t);
  } else {
    HWY_ALIGN std::int32_t piece[lanes];
    hn::Store(hn::DemoteTo(di, whole), di, piece);
    if constexpr (embedded) {
      const ValueSlope f = cubic(load_columns(k.table[0].density, 8, piece), t);
      jets.density = f.value;
      jets.slope = f.slope;
    }
    jets.pull = parabola(load_columns(k.table[0].pull, 8, piece), t);
  }
  jets.slope = hn::Mul(jets.slope, inverse);
  jets.pull = hn::Mul(jets.pull, inverse);
  if constexpr (is_tail) {
    jets.density = hn::IfThenElse(live, jets.density, zero);
    jets.slope = hn::IfThenElse(live, jets.slope, zero);
    jets.pull = hn::IfThenElse(live, jets.pull, zero);
  }
  return jets;
}

template <int dim>
HWY_INLINE void load_own(const RowArrays &k, int s, V *own)
{
  for (int c = 0; c < dim; ++c)
    own[c] = hn::LoadU(D(), k.displacement[c] + s);
}

HWY_INLINE void add_to(double *at, V v)
{
  const D d;
  hn::StoreU(hn::Add(hn::LoadU(d, at), v), d, at);
}

template <int dim, bool is_tail>
HWY_INLINE void first_vector(const RowArrays &k, const RowTask &task, int s, double *between)
{
  const D d;
  V own[dim], sum = hn::Zero(d);
  load_own<dim>(k, s, own);
  const auto live = hn::FirstN(d, std::size_t(task.last - s));
  for (int b = 0; b < task.n_bonds; ++b) {
    const LaneBond<dim> bond(k, task, b, s, own);
    const LaneJets jets = look_up<true, is_tail>(k, bond.squared_length(), live);
    sum = hn::Add(sum, jets.density);
    add_to(k.density + s + task.shift[b], jets.density);
    hn::StoreU(jets.slope, d, between + 2 * b * lanes);
    hn::StoreU(jets.pull, d, between + (2 * b + 1) * lanes);
  }
  add_to(k.density + s, sum);
}

/// `scale`: the force on the neighbour over the vector to it, N/m.
template <int dim>
HWY_INLINE void push(const RowArrays &k, int j, V scale, const LaneBond<dim> &bond, V *sum)
{
  const D d;
  for (int c = 0; c < dim; ++c) {
    sum[c] = hn::NegMulAdd(scale, bond.x[c], sum[c]);
    double *const at = k.force[c] + j;
    hn::StoreU(hn::MulAdd(scale, bond.x[c], hn::LoadU(d, at)), d, at);
  }
}

template <int dim>
HWY_INLINE void second_vector(const RowArrays &k, const RowTask &task, int s, const double *between)
{
  const D d;
  V own[dim], sum[dim];
  load_own<dim>(k, s, own);
  for (V &component : sum)
    component = hn::Zero(d);
  const V slope = hn::LoadU(d, k.slope + s);
  for (int b = 0; b < task.n_bonds; ++b) {
    const int j = s + task.shift[b];
    const V scale =
        hn::MulAdd(hn::Add(slope, hn::LoadU(d, k.slope + j)), hn::LoadU(d, between + 2 * b * lanes),
                   hn::LoadU(d, between + (2 * b + 1) * lanes));
    push<dim>(k, j, scale, LaneBond<dim>(k, task, b, s, own), sum);
  }
  for (int c = 0; c < dim; ++c)
    add_to(k.force[c] + s, sum[c]);
}

template <int dim, bool is_tail>
HWY_INLINE void pair_vector(const RowArrays &k, const RowTask &task, int s)
{
  const D d;
  V own[dim], sum[dim];
  load_own<dim>(k, s, own);
  for (V &component : sum)
    component = hn::Zero(d);
  const auto live = hn::FirstN(d, std::size_t(task.last - s));
  for (int b = 0; b < task.n_bonds; ++b) {
    const LaneBond<dim> bond(k, task, b, s, own);
    const V scale = look_up<false, is_tail>(k, bond.squared_length(), live).pull;
    push<dim>(k, s + task.shift[b], scale, bond, sum);
  }
  for (int c = 0; c < dim; ++c)
    add_to(k.force[c] + s, sum[c]);
}

template <int dim>
void first_pass(const RowArrays &k, const RowTask &task)
{
  double *between = task.between;
  int s = task.first;
  for (; s + lanes <= task.last; s += lanes, between += 2 * task.n_bonds * lanes)
    first_vector<dim, false>(k, task, s, between);
  if (s < task.last)
    first_vector<dim, true>(k, task, s, between);
}

template <int dim>
void second_pass(const RowArrays &k, const RowTask &task)
{
  const double *between = task.between;
  for (int s = task.first; s < task.last; s += lanes, between += 2 * task.n_bonds * lanes)
    second_vector<dim>(k, task, s, between);
}

template <int dim>
void pair_pass(const RowArrays &k, const RowTask &task)
{
  int s = task.first;
  for (; s + lanes <= task.last; s += lanes)
    pair_vector<dim, false>(k, task, s);
  if (s < task.last)
    pair_vector<dim, true>(k, task, s);
}

// As Spline has it: beyond its ends along the tangents.
void slope_pass(const RowArrays &k, const RowTask &task)
{
  const D d;
  const hn::Rebind<std::int32_t, D> di;
  const V zero = hn::Zero(d), n = hn::Set(d, k.n_embedding), last = hn::Set(d, k.n_embedding - 1),
          step = hn::Set(d, k.embedding_step),
          factor = hn::Set(d, -k.inverse_step / k.embedding_step);
  for (int s = task.first; s < task.last; s += lanes) {
    const V place = hn::Min(hn::Max(hn::Div(hn::LoadU(d, k.density + s), step), zero), n),
            whole = hn::Min(hn::Trunc(place), last);
    HWY_ALIGN std::int32_t piece[lanes];
    hn::Store(hn::DemoteTo(di, whole), di, piece);
    const Columns c = load_columns(k.embedding, 4, piece);
    const V slope = hn::Mul(cubic(c, hn::Sub(place, whole)).slope, factor);
    if (s + lanes <= task.last)
      hn::StoreU(slope, d, k.slope + s);
    else {
      HWY_ALIGN double rest[lanes];
      hn::Store(slope, d, rest);
      for (int m = 0; s + m < task.last; ++m)
        k.slope[s + m] = rest[m];
    }
  }
}

template <int dim>
double largest_rest(const RowArrays &k, const RowTask &task, const double *base,
                    const double *gradient)
{
  const D d;
  const double infinity = std::numeric_limits<double>::infinity();
  V n = hn::Iota(d, 0), worst = hn::Zero(d);
  const V limit = hn::Set(d, infinity);
  for (int s = task.first; s < task.last; s += lanes, n = hn::Add(n, hn::Set(d, double(lanes)))) {
    V r2 = hn::Zero(d);
    for (int c = 0; c < dim; ++c) {
      const V w = hn::NegMulAdd(n, hn::Set(d, gradient[c]),
                                hn::Sub(hn::LoadU(d, k.displacement[c] + s), hn::Set(d, base[c])));
      r2 = hn::MulAdd(w, w, r2);
    }
    r2 = hn::IfThenElse(hn::Le(r2, limit), r2, limit);
    if (s + lanes > task.last)
      r2 = hn::IfThenElse(hn::FirstN(d, std::size_t(task.last - s)), r2, hn::Zero(d));
    worst = hn::Max(worst, r2);
  }
  return hn::GetLane(hn::MaxOfLanes(d, worst));
}

template <int dim>
RowPasses passes()
{
  return {&first_pass<dim>, &slope_pass, &second_pass<dim>, &pair_pass<dim>, &largest_rest<dim>};
}
RowPasses choose_plane()
{
  return passes<2>();
}
RowPasses choose_space()
{
  return passes<3>();
}
} // namespace ligament::md::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ligament::md
{
HWY_EXPORT(choose_plane);
HWY_EXPORT(choose_space);

template <>
RowPasses row_passes<2>()
{
  return HWY_DYNAMIC_DISPATCH(choose_plane)();
}
template <>
RowPasses row_passes<3>()
{
  return HWY_DYNAMIC_DISPATCH(choose_space)();
}
} // namespace ligament::md
#endif
