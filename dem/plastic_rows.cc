// Compiled once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dem/plastic_rows.cc"
#include "core/dispatch.h"

#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway wants it.
#include "dem/lattice_rows.h"
#include "dem/plastic_rows.h"
#include "dem/sine.h"

HWY_BEFORE_NAMESPACE();
namespace ligament::dem::HWY_NAMESPACE
{
/// dim components of a vector of particles, or the columns of a matrix.
template <typename V, int dim>
struct Several
{
  V c[dim];
};

/// theory.md eqs. (D20), (D21) for vectors of particles that are neighbours in a row.
template <int dim>
class PlasticBonds
{
public:
  using Sums = typename PlasticRows<dim>::Sums;

  HWY_INLINE explicit PlasticBonds(const PlasticRows<dim> &rows) : r_(rows), c_(rows.constants) {}

  template <typename D>
  HWY_INLINE void turn(D d, long i) const
  {
    using V = hn::Vec<D>;
    V change[dim][dim], strain[dim][dim];
    rotation_less_1(d, i, change);
    for (int a = 0; a < dim; ++a)
      for (int b = 0; b < dim; ++b)
        strain[a][b] = hn::LoadU(d, r_.strain[place(a, b)] + i);
    for (int a = 0; a < dim; ++a)
      for (int b = 0; b < dim; ++b) {
        V turned = strain[a][b];
        for (int k = 0; k < dim; ++k)
          turned = hn::MulAdd(change[a][k], strain[k][b], turned);
        hn::StoreU(change[a][b], d, stream(dim * a + b) + i);
        hn::StoreU(turned, d, stream(dim * dim + dim * a + b) + i);
      }
  }

  template <Sums what, typename D>
  HWY_INLINE void sum(D d, long i, long place, const RowSegment &segment) const
  {
    using V = hn::Vec<D>;
    constexpr int n_sums =
        what == Sums::forces ? PlasticRows<dim>::n_forces : PlasticRows<dim>::n_stresses;
    V sums[n_sums];
    for (V &s : sums)
      s = hn::Zero(d);
    const BondMask<D> mask(d, r_.arrays.mask, i);
    const int n = c_.n_directions;
    for (int k = 0; k < n; ++k) {
      add_bond<what>(d, i, i + segment.forward[k], c_.normal[k], 1., mask, k, sums);
      add_bond<what>(d, i, i + segment.backward[k], c_.normal[k], -1., mask, n + k, sums);
    }
    for (int k = 0; k < n_sums; ++k)
      hn::StoreU(sums[k], d, r_.sums + k * TractionScreen::block + place);
  }

private:
  static constexpr int place(int a, int b) { return a == b ? a : 6 - a - b; }
  HWY_INLINE double *stream(int k) const { return r_.turned + k * r_.stride; }

  template <typename D>
  HWY_INLINE void rotation_less_1(D d, long i, hn::Vec<D> (&h)[dim][dim]) const
  {
    using V = hn::Vec<D>;
    const auto load = [&](int k) HWY_ATTR { return hn::LoadU(d, r_.arrays.rotation[k] + i); };
    if constexpr (dim == 2) {
      V c, s;
      cosine_minus_1_and_sine(d, load(0), c, s);
      h[0][0] = h[1][1] = c;
      h[0][1] = hn::Neg(s);
      h[1][0] = s;
    } else {
      const V q[4] = {load(0), load(1), load(2), load(3)};
      const auto twice = [&](int a, int b) HWY_ATTR { return hn::Mul(hn::Add(q[a], q[a]), q[b]); };
      for (int a = 0; a < 3; ++a) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        h[a][a] = hn::Neg(hn::Add(twice(b + 1, b + 1), twice(c + 1, c + 1)));
        h[b][a] = hn::Add(twice(a + 1, b + 1), twice(0, c + 1));
        h[c][a] = hn::Sub(twice(a + 1, c + 1), twice(0, b + 1));
      }
    }
  }

  /// Matrix of the streams from `first` on times n.
  template <typename D>
  HWY_INLINE Several<hn::Vec<D>, dim> times(D d, int first, long i,
                                            const Several<hn::Vec<D>, dim> &n) const
  {
    Several<hn::Vec<D>, dim> v;
    for (int a = 0; a < dim; ++a) {
      v.c[a] = hn::Mul(hn::LoadU(d, stream(first + dim * a) + i), n.c[0]);
      for (int b = 1; b < dim; ++b)
        v.c[a] = hn::MulAdd(hn::LoadU(d, stream(first + dim * a + b) + i), n.c[b], v.c[a]);
    }
    return v;
  }

  /// Of the bond to particle j, as i sees it.
  template <Sums what, typename D>
  HWY_INLINE void add_bond(D d, long i, long j, const std::array<double, dim> &direction,
                           double sign, const BondMask<D> &mask, int bit, hn::Vec<D> *sums) const
  {
    using V = hn::Vec<D>;
    Several<V, dim> n, du, whole_part, a_i, f, rest;
    for (int c = 0; c < dim; ++c)
      n.c[c] = hn::Set(d, sign * direction[c]);
    const auto h_i = times(d, 0, i, n), h_j = times(d, 0, j, n);
    const auto b_i = times(d, dim * dim, i, n), b_j = times(d, dim * dim, j, n);
    const V q = hn::Set(d, c_.half), stiffness = hn::Set(d, c_.shear);
    for (int c = 0; c < dim; ++c) {
      const double *const u = r_.arrays.displacement[c];
      du.c[c] = hn::NegMulAdd(q, hn::Add(h_i.c[c], h_j.c[c]),
                              hn::Sub(hn::LoadU(d, u + j), hn::LoadU(d, u + i)));
      whole_part.c[c] = hn::Mul(q, hn::Add(b_i.c[c], b_j.c[c]));
      a_i.c[c] = hn::Mul(q, hn::Add(n.c[c], h_i.c[c]));
      f.c[c] = mask(hn::Mul(stiffness, whole_part.c[c]), bit);
      rest.c[c] = mask(hn::Mul(stiffness, hn::Sub(du.c[c], whole_part.c[c])), bit);
    }
    if constexpr (what == Sums::stresses) {
      const V s_r = hn::Set(d, c_.area_r);
      const V p_i = hn::Mul(s_r, hn::LoadU(d, r_.arrays.pressure + i)),
              p_j = hn::Mul(s_r, hn::LoadU(d, r_.arrays.pressure + j));
      for (int c = 0; c < dim; ++c) {
        const V a_j = hn::Mul(q, hn::Add(n.c[c], h_j.c[c]));
        const V pressed = hn::MulAdd(p_i, a_i.c[c], hn::Mul(p_j, a_j));
        const V whole = hn::Add(rest.c[c], mask(pressed, bit));
        for (int e = 0; e < dim; ++e)
          sums[dim * c + e] = hn::MulAdd(whole, a_i.c[e], sums[dim * c + e]);
      }
    } else {
      Several<V, dim> part;
      V &energy = sums[n_particle_dofs<dim>];
      for (int c = 0; c < dim; ++c) {
        // The bond's energy changes by 1/2 k (|Du - part|^2 - |Du|^2), f = k part.
        energy = hn::NegMulAdd(hn::Mul(hn::Set(d, 0.25), f.c[c]),
                               hn::Add(du.c[c], hn::Sub(du.c[c], whole_part.c[c])), energy);
        sums[c] = hn::Sub(sums[c], f.c[c]);
        part.c[c] = hn::Mul(q, b_i.c[c]);
      }
      for (int s = 0; s < n_spins<dim>; ++s) {
        const int x = dim == 2 ? 0 : (s + 1) % 3, y = dim == 2 ? 1 : (s + 2) % 3;
        V t = sums[dim + s];
        t = hn::NegMulAdd(a_i.c[x], f.c[y], hn::MulAdd(a_i.c[y], f.c[x], t));
        sums[dim + s] = hn::MulAdd(part.c[x], rest.c[y], hn::NegMulAdd(part.c[y], rest.c[x], t));
      }
    }
  }

  const PlasticRows<dim> &r_;
  const LatticeConstants<dim> &c_;
};

template <int dim>
void turn_block(const PlasticRows<dim> &rows, const RowRange &block)
{
  const PlasticBonds<dim> bonds(rows);
  for_each_vector(block.begin, block.begin, block.end,
                  [&](auto d, long i) HWY_ATTR { bonds.turn(d, i); });
}

template <int dim, typename PlasticRows<dim>::Sums what>
void sum_block(const PlasticRows<dim> &rows, const RowRange &block)
{
  const PlasticBonds<dim> bonds(rows);
  auto segment = std::partition_point(rows.segments->begin(), rows.segments->end(),
                                      [&](const RowSegment &s) { return s.end <= block.begin; });
  for (; segment != rows.segments->end() && segment->begin < block.end; ++segment) {
    const int begin = std::max(segment->begin, block.begin),
              end = std::min(segment->end, block.end);
    for_each_vector(begin, begin, end, [&](auto d, long i) HWY_ATTR {
      bonds.template sum<what>(d, i, i - block.begin, *segment);
    });
  }
}

template <int dim>
void sum_block_of(const PlasticRows<dim> &rows, const RowRange &block,
                  typename PlasticRows<dim>::Sums what)
{
  using Sums = typename PlasticRows<dim>::Sums;
  if (what == Sums::forces)
    sum_block<dim, Sums::forces>(rows, block);
  else
    sum_block<dim, Sums::stresses>(rows, block);
}

void turn_2d(const PlasticRows<2> &rows, const RowRange &block)
{
  turn_block<2>(rows, block);
}
void turn_3d(const PlasticRows<3> &rows, const RowRange &block)
{
  turn_block<3>(rows, block);
}
void sum_2d(const PlasticRows<2> &rows, const RowRange &block, PlasticRows<2>::Sums what)
{
  sum_block_of<2>(rows, block, what);
}
void sum_3d(const PlasticRows<3> &rows, const RowRange &block, PlasticRows<3>::Sums what)
{
  sum_block_of<3>(rows, block, what);
}
} // namespace ligament::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ligament::dem
{
HWY_EXPORT(turn_2d);
HWY_EXPORT(turn_3d);
HWY_EXPORT(sum_2d);
HWY_EXPORT(sum_3d);

void turn_plastic(const PlasticRows<2> &rows, const RowRange &block)
{
  HWY_DYNAMIC_DISPATCH(turn_2d)(rows, block);
}
void turn_plastic(const PlasticRows<3> &rows, const RowRange &block)
{
  HWY_DYNAMIC_DISPATCH(turn_3d)(rows, block);
}
void sum_plastic(const PlasticRows<2> &rows, const RowRange &block, PlasticRows<2>::Sums what)
{
  HWY_DYNAMIC_DISPATCH(sum_2d)(rows, block, what);
}
void sum_plastic(const PlasticRows<3> &rows, const RowRange &block, PlasticRows<3>::Sums what)
{
  HWY_DYNAMIC_DISPATCH(sum_3d)(rows, block, what);
}
} // namespace ligament::dem
#endif
