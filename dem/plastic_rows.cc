// Compiled once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dem/plastic_rows.cc"
#include "core/dispatch.h"

#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway wants it.
#include "dem/lattice_rows.h"
#include "dem/laws/eigenstretch.h"
#include "dem/laws/elastic_bond.h"
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
    using Vector = std::conditional_t<dim == 2, Pair<V>, Triple<V>>;
    Several<V, dim> n, du, a_i, part;
    for (int c = 0; c < dim; ++c)
      n.c[c] = hn::Set(d, sign * direction[c]);
    const auto h_i = times(d, 0, i, n), h_j = times(d, 0, j, n);
    const auto b_i = times(d, dim * dim, i, n), b_j = times(d, dim * dim, j, n);
    const V q = hn::Set(d, c_.half);
    for (int c = 0; c < dim; ++c) {
      const double *const u = r_.arrays.displacement[c];
      du.c[c] = hn::NegMulAdd(q, hn::Add(h_i.c[c], h_j.c[c]),
                              hn::Sub(hn::LoadU(d, u + j), hn::LoadU(d, u + i)));
      a_i.c[c] = hn::Mul(q, hn::Add(n.c[c], h_i.c[c]));
      part.c[c] = hn::Add(b_i.c[c], b_j.c[c]);
    }
    const Vector b = q * vector(part), motion = vector(du), lever = vector(a_i);
    const V shear = mask(hn::Set(d, c_.shear), bit);
    if constexpr (what == Sums::stresses) {
      const V s_r = mask(hn::Set(d, c_.area_r), bit);
      Several<V, dim> a_j;
      for (int c = 0; c < dim; ++c)
        a_j.c[c] = hn::Neg(hn::Mul(q, hn::Add(n.c[c], h_j.c[c])));
      const ElasticBond<V, Vector> law{shear, s_r};
      const Vector whole = law.force(motion - b, hn::LoadU(d, r_.arrays.pressure + i), lever,
                                     hn::LoadU(d, r_.arrays.pressure + j), vector(a_j));
      const Several<V, dim> f = components(whole);
      for (int c = 0; c < dim; ++c)
        for (int e = 0; e < dim; ++e)
          sums[dim * c + e] = hn::MulAdd(f.c[c], a_i.c[e], sums[dim * c + e]);
    } else {
      const Eigenstretch<V, Vector> law{shear};
      const Vector lost = law.lost(b);
      const Several<V, dim> f = components(lost);
      for (int c = 0; c < dim; ++c)
        sums[c] = hn::Sub(sums[c], f.c[c]);
      V &energy = sums[n_particle_dofs<dim>]; // half of the bond's
      energy = hn::NegMulAdd(hn::Set(d, 0.25), law.twice_lost_energy(lost, motion, b), energy);
      const Vector own = q * vector(b_i);
      if constexpr (dim == 2)
        sums[2] = law.add_torque(lost, motion, lever, own, sums[2]);
      else {
        const Vector torque =
            law.add_torque(lost, motion, lever, own, Vector{sums[3], sums[4], sums[5]});
        sums[3] = torque.x, sums[4] = torque.y, sums[5] = torque.z;
      }
    }
  }

  template <typename V>
  static HWY_INLINE auto vector(const Several<V, dim> &a)
  {
    if constexpr (dim == 2)
      return Pair<V>{a.c[0], a.c[1]};
    else
      return Triple<V>{a.c[0], a.c[1], a.c[2]};
  }
  template <typename Vector>
  static HWY_INLINE auto components(const Vector &a)
  {
    Several<decltype(a.x), dim> v;
    v.c[0] = a.x, v.c[1] = a.y;
    if constexpr (dim == 3)
      v.c[2] = a.z;
    return v;
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
