// Compiled once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dem/lattice_kernel_2d.cc"
#include "core/dispatch.h"

#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway wants it.
#include "dem/inelastic/response.h"
#include "dem/lane_vectors.h"
#include "dem/lattice_rows.h"
#include "dem/laws/bending.h"
#include "dem/laws/elastic_bond.h"
#include "dem/sine.h"
#include "dem/stress_bound.h"

HWY_BEFORE_NAMESPACE();
namespace ligament::dem::HWY_NAMESPACE
{
/// theory.md eqs. (D4), (D6), (D8b), (D8c) for vectors of particles that are neighbours in a row.
/// With h = (R - I) n and v = q S/r, the force on a face is
///   S t = 2G S/r (u_j - u_i) + (g_i + g_j), g = v p n + (v p - 2G S/r q) h,
/// formed by the same operations from either end, so that pair forces cancel exactly. Kept of each
/// particle are the two numbers of h and of g along n and along its normal. Strains of their own
/// take 2G S/r q R e n from g, eq. (D22), which is kept for two directions.
template <int n_dir, long stride_, bool inelastic_>
class Bonds2d
{
public:
  static constexpr long stride = stride_;
  static constexpr bool inelastic = inelastic_;
  static constexpr int n_streams = inelastic_ ? 10 : 9;
  using Offsets = NeighbourOffsets<n_dir>;

  HWY_INLINE explicit Bonds2d(const RowSweep<2> &sweep)
      : a_(sweep.arrays),
        c_(sweep.constants), law_{c_.shear, c_.half, c_.shear * c_.half, c_.area_r * c_.half},
        volumetric_(sweep.volumetric), inelastic_sweep_(sweep.inelastic)
  {
    const auto &n = c_.normal;
    third_ = n_dir == 3 && n[0][0] * n[2][0] + n[0][1] * n[2][1] < 0 ? -1 : 1;
  }

  HWY_INLINE void set_window(double *origin) { w_ = origin; }

  template <typename D>
  HWY_INLINE void turn(D d, long i) const
  {
    prefetch(a_.displacement, i);
    prefetch(a_.rotation, i);
    double *const at = w_ + i;
    for (int c = 0; c < 2; ++c)
      hn::StoreU(hn::LoadU(d, a_.displacement[c] + i), d, at + (u_ + c) * stride);
    const auto angle = hn::LoadU(d, a_.rotation[0] + i);
    hn::StoreU(angle, d, at + angle_ * stride);
    hn::Vec<D> c, s;
    cosine_minus_1_and_sine(d, angle, c, s);
    const Pair<hn::Vec<D>> h{c, s};
    store(d, h, at + h_ * stride);
    if (inelastic)
      return;
    if (volumetric_)
      hn::StoreU(hn::Zero(d), d, at + other_ * stride);
    else
      store(d, law_.part(h), at + g_ * stride);
  }

  /// After turn() of the particle.
  HWY_INLINE void take_other_pressure(int i) const { w_[other_ * stride + i] = a_.pressure[i]; }

  template <typename D>
  HWY_INLINE void dilatation(D d, long i, const Offsets &offsets) const
  {
    prefetch(std::array{a_.lambda_per_volume, static_cast<const double *>(a_.pressure)}, i);
    const BondMask<D> mask(d, a_.mask, i);
    auto theta = hn::Zero(d), moment = hn::Zero(d);
    double *const at = w_ + i;
    const auto u = displacement(d, at);
    for_directions([&](auto direction) HWY_ATTR {
      constexpr int k = decltype(direction)::value;
      const double *const f = at + offsets.forward[k], *const b = at + offsets.backward[k];
      const auto h = along<k, h_>(d, at);
      auto forward = law_.relative(displacement(d, f) - u, h + along<k, h_>(d, f));
      auto backward = law_.relative(u - displacement(d, b), along<k, h_>(d, b) + h);
      const auto e = masked(mask, forward, k) + masked(mask, backward, n_dir + k);
      const auto a = normal(d, k) + h;
      theta = add_dot(a, e, theta);
      moment = add_cross(a, e, moment);
    });
    const auto p = law_.pressure(hn::LoadU(d, a_.lambda_per_volume + i), theta,
                                 hn::LoadU(d, at + other_ * stride));
    hn::StoreU(p, d, a_.pressure + i);
    hn::StoreU(moment, d, at + moment_ * stride);
    const auto vp = law_.pressing(p);
    const auto h = load(d, at + h_ * stride);
    store(d, law_.part_along(vp, h), at + g_ * stride);
  }

  /// The same of particles with strains of their own, which flow behind `done`.
  template <typename D>
  HWY_INLINE void strain(D d, long i, const Offsets &offsets, int done) const
  {
    using V = hn::Vec<D>;
    const InARow<2, D> place{i};
    prefetch(std::array{a_.lambda_per_volume, static_cast<const double *>(a_.pressure)}, i);
    place.prefetch(a_.mask);
    place.prefetch(inelastic_sweep_->open);
    const BondMask<D> mask(d, a_.mask, i);
    const V zero = hn::Zero(d);
    double *const at = w_ + i;
    const auto u = displacement(d, at);
    Pair<V> sum[2] = {{zero, zero}, {zero, zero}}; // of Du (x) n, column by column
    const auto add = [&](const Pair<V> &both, int k) HWY_ATTR {
      const auto n = normal(d, k);
      sum[0] = mul_add(n.x, both, sum[0]);
      sum[1] = mul_add(n.y, both, sum[1]);
    };
    const auto h = load(d, at + h_ * stride); // cos - 1, sin
    // Whole vectors without the masks, with the same bits.
    if (HWY_LIKELY(hn::AllTrue(d, mask.all(2 * n_dir))))
      for_directions([&](auto direction) HWY_ATTR {
        constexpr int k = decltype(direction)::value;
        const double *const f = at + offsets.forward[k], *const b = at + offsets.backward[k];
        const auto around = (load(d, f + h_ * stride) + h) + (load(d, b + h_ * stride) + h);
        add(law_.relative(displacement(d, f) - displacement(d, b), turned_normal<k>(d, around)), k);
      });
    else
      for_directions([&](auto direction) HWY_ATTR {
        constexpr int k = decltype(direction)::value;
        const double *const f = at + offsets.forward[k], *const b = at + offsets.backward[k];
        const auto around = masked(mask, load(d, f + h_ * stride) + h, k) +
                            masked(mask, load(d, b + h_ * stride) + h, n_dir + k);
        const auto apart = where_carries(mask, k, displacement(d, f), u) -
                           where_carries(mask, n_dir + k, displacement(d, b), u);
        add(law_.relative(apart, turned_normal<k>(d, around)), k);
      });
    const V factor = hn::Set(d, law_.volumetric);
    const V middle = hn::Add(sum[0].x, sum[1].y), turn = hn::Sub(sum[0].y, sum[1].x);
    const V theta = hn::Mul(factor, hn::Add(middle, hn::MulAdd(h.x, middle, hn::Mul(h.y, turn))));
    const V moment = hn::Add(turn, hn::NegMulAdd(h.y, middle, hn::Mul(h.x, turn))); // a x Du
    const V lambda_per_volume = hn::LoadU(d, a_.lambda_per_volume + i);
    Answer<2, V> response(zero_tensor<2>(zero), hn::Mul(lambda_per_volume, theta), false);
    const double per_volume = law_.volumetric * inelastic_sweep_->per_whole_volume;
    const V square =
        hn::Mul(hn::Set(d, per_volume * per_volume), add_dot(sum[0], sum[0], dot(sum[1], sum[1])));
    V x[2][2] = {{zero, zero}, {zero, zero}}; // R^T sum times S q / r
    if (!is_quiet<2>(d, *inelastic_sweep_, place, square)) {
      for (int b = 0; b < 2; ++b) {
        const auto &own = sum[b];
        x[0][b] = hn::Mul(factor, hn::Add(own.x, hn::MulAdd(h.x, own.x, hn::Mul(h.y, own.y))));
        x[1][b] = hn::Mul(factor, hn::Add(own.y, hn::NegMulAdd(h.y, own.x, hn::Mul(h.x, own.y))));
      }
      const auto fresh = hn::Not(hn::FirstN(d, std::size_t(std::max(done - i, 0L))));
      response = respond<2>(d, *inelastic_sweep_, place, fresh, x, theta, lambda_per_volume);
    }
    const V p = response.pressure, vp = law_.pressing(p);
    hn::StoreU(p, d, a_.pressure + i);
    V torque = hn::Neg(hn::Mul(vp, moment));
    const auto part = law_.part_along(vp, h);
    Pair<V> g[2] = {turned_normal<0>(d, part), turned_normal<1>(d, part)};
    if (response.is_strained) {
      const auto &e = response.strain;
      const V shear_half = hn::Set(d, law_.shear_half);
      const auto moved = [&](int a, int b) HWY_ATTR { // X e
        return hn::MulAdd(x[a][0], e(0, b), hn::Mul(x[a][1], e(1, b)));
      };
      const V modulus = hn::Set(d, law_.shear_half / law_.volumetric);
      torque = hn::MulAdd(modulus, hn::Sub(moved(1, 0), moved(0, 1)), torque);
      for (int m = 0; m < 2; ++m) {
        const auto n = normal(d, m);
        const Pair<V> en{hn::MulAdd(e(0, 0), n.x, hn::Mul(e(0, 1), n.y)),
                         hn::MulAdd(e(1, 0), n.x, hn::Mul(e(1, 1), n.y))};
        const Pair<V> change{hn::NegMulAdd(h.y, en.y, hn::Mul(h.x, en.x)),
                             hn::MulAdd(h.y, en.x, hn::Mul(h.x, en.y))};
        g[m] = neg_mul_add(shear_half, en + change, g[m]);
      }
    }
    hn::StoreU(torque, d, at + moment_ * stride);
    for (int m = 0; m < 2; ++m)
      store(d, g[m], at + basis(m) * stride);
  }

  /// Also finds the particles to look at: those with a forward face whose force, in any direction,
  /// reaches the limit; or, by particle, with any face that eq. (D12d) does not clear.
  template <bool by_particle, typename D>
  HWY_INLINE hn::Mask<D> forces(D d, long i, const Offsets &offsets) const
  {
    using V = hn::Vec<D>;
    prefetch(a_.force, i);
    prefetch(a_.torque, i);
    const BondMask<D> mask(d, a_.mask, i);
    const V zero = hn::Zero(d);
    Pair<V> force{zero, zero};
    V torque = zero, bend = zero, largest = zero; // by particle: twice the sum of all forces^2
    StressSum2d<V> stress(d);
    double *const at = w_ + i;
    const auto u = displacement(d, at);
    const V angle = hn::LoadU(d, at + angle_ * stride);
    for_directions([&](auto direction) HWY_ATTR {
      constexpr int k = decltype(direction)::value;
      const double *const f = at + offsets.forward[k], *const b = at + offsets.backward[k];
      const auto g = part<k>(d, at);
      const auto t_f = masked(mask, law_.force(displacement(d, f) - u, g + part<k>(d, f)), k);
      const auto t_b =
          masked(mask, law_.force(u - displacement(d, b), part<k>(d, b) + g), n_dir + k);
      const auto net = t_f - t_b, both = t_f + t_b, a = normal(d, k) + along<k, h_>(d, at);
      force = force + net;
      torque = add_cross(a, both, torque);
      if constexpr (by_particle) {
        stress.add(a, both);
        largest = add_dot(net, net, add_dot(both, both, largest));
      } else
        largest = hn::Max(largest, add_dot(t_f, t_f, zero));
      bend = hn::Add(bend,
                     hn::Sub(mask(hn::Sub(hn::LoadU(d, f + angle_ * stride), angle), k),
                             mask(hn::Sub(angle, hn::LoadU(d, b + angle_ * stride)), n_dir + k)));
    });
    const auto look = [&]() HWY_ATTR {
      if constexpr (by_particle)
        return not_cleared<n_dir, 2>(d, c_, mask, hn::Abs(angle), stress, torque, largest);
      else
        return hn::Ge(largest, hn::Set(d, c_.limit2));
    }();
    torque = law_.torque(torque);
    if constexpr (inelastic)
      torque = hn::Add(torque, hn::LoadU(d, at + moment_ * stride));
    else if (volumetric_)
      torque = law_.add_torque_of_pressure(hn::LoadU(d, a_.pressure + i),
                                           hn::LoadU(d, at + moment_ * stride), torque);
    torque = bending(d).add_torque(bend, torque);
    hn::StoreU(force.x, d, a_.force[0] + i);
    hn::StoreU(force.y, d, a_.force[1] + i);
    hn::StoreU(torque, d, a_.torque[0] + i);
    return look;
  }

  /// Of the forward bonds.
  template <typename D>
  HWY_INLINE hn::Vec<D> energy(D d, long i, const Offsets &offsets) const
  {
    const BondMask<D> mask(d, a_.mask, i);
    auto du2 = hn::Zero(d), angle2 = hn::Zero(d);
    double *const at = w_ + i;
    const auto u = displacement(d, at);
    const auto angle = hn::LoadU(d, at + angle_ * stride);
    for_directions([&](auto direction) HWY_ATTR {
      constexpr int k = decltype(direction)::value;
      const double *const f = at + offsets.forward[k];
      const auto h = along<k, h_>(d, at) + along<k, h_>(d, f);
      const auto du = masked(mask, law_.relative(displacement(d, f) - u, h), k);
      const auto turn = mask(hn::Sub(hn::LoadU(d, f + angle_ * stride), angle), k);
      du2 = add_dot(du, du, du2);
      angle2 = hn::MulAdd(turn, turn, angle2);
    });
    return hn::Mul(hn::Set(d, 0.5), bending(d).add_twice_energy(angle2, law_.twice_energy(du2)));
  }

  /// The particles with a forward face that could break, with `backward` with any face.
  template <bool backward, typename D>
  HWY_INLINE hn::Mask<D> could_break(D d, long i, const Offsets &offsets) const
  {
    const BondMask<D> mask(d, a_.mask, i);
    auto found = hn::Lt(hn::Zero(d), hn::Zero(d));
    double *const at = w_ + i;
    for_directions([&](auto direction) HWY_ATTR {
      constexpr int k = decltype(direction)::value;
      found = hn::Or(found, face_reaches<k>(d, mask, k, at, at + offsets.forward[k]));
      if (backward)
        found = hn::Or(found, face_reaches<k>(d, mask, n_dir + k, at + offsets.backward[k], at));
    });
    return found;
  }

private:
  template <typename D>
  HWY_INLINE PlaneBending<hn::Vec<D>> bending(D d) const
  {
    return {hn::Set(d, c_.bending)};
  }

  /// Of the face in direction k between two particles, bit `bit` of the mask.
  template <int k, typename D>
  HWY_INLINE hn::Mask<D> face_reaches(D d, const BondMask<D> &mask, int bit, const double *from,
                                      const double *to) const
  {
    const auto t = masked(
        mask,
        law_.force(displacement(d, to) - displacement(d, from), part<k>(d, from) + part<k>(d, to)),
        bit);
    const auto n = normal(d, k);
    const auto mean = (n + n) + (along<k, h_>(d, from) + along<k, h_>(d, to));
    return reaches(d, t, mean, hn::Set(d, c_.strength), c_.tangent);
  }

  template <typename Visit, int... k>
  static HWY_INLINE void for_directions(Visit &&visit, std::integer_sequence<int, k...>)
  {
    (visit(std::integral_constant<int, k>()), ...);
  }
  template <typename Visit>
  static HWY_INLINE void for_directions(Visit &&visit)
  {
    for_directions(visit, std::make_integer_sequence<int, n_dir>());
  }

  /// Two streams from one on.
  template <typename D>
  static HWY_INLINE Pair<hn::Vec<D>> load(D d, const double *p)
  {
    return {hn::LoadU(d, p), hn::LoadU(d, p + stride)};
  }
  template <typename D>
  static HWY_INLINE void store(D d, const Pair<hn::Vec<D>> &v, double *p)
  {
    hn::StoreU(v.x, d, p);
    hn::StoreU(v.y, d, p + stride);
  }
  template <typename D>
  static HWY_INLINE Pair<hn::Vec<D>> displacement(D d, const double *at)
  {
    return load(d, at + u_ * stride);
  }
  template <typename D>
  HWY_INLINE Pair<hn::Vec<D>> normal(D d, int k) const
  {
    return {hn::Set(d, c_.normal[k][0]), hn::Set(d, c_.normal[k][1])};
  }
  /// The vector whose parts along the normal of direction k and across it are kept.
  template <int k, int first, typename D>
  HWY_INLINE Pair<hn::Vec<D>> along(D d, const double *at) const
  {
    return turned_normal<k>(d, load(d, at + first * stride));
  }
  /// The vector with these parts along the normal of direction k and across it.
  template <int k, typename D>
  HWY_INLINE Pair<hn::Vec<D>> turned_normal(D d, const Pair<hn::Vec<D>> &part) const
  {
    const auto n = normal(d, k);
    return {hn::NegMulAdd(part.y, n.y, hn::Mul(part.x, n.x)),
            hn::MulAdd(part.y, n.x, hn::Mul(part.x, n.y))};
  }
  /// g of direction k.
  template <int k, typename D>
  HWY_INLINE Pair<hn::Vec<D>> part(D d, const double *at) const
  {
    if constexpr (inelastic) {
      if constexpr (k < 2)
        return load(d, at + basis(k) * stride);
      else
        return mul_add(hn::Set(d, third_), load(d, at + basis(0) * stride),
                       load(d, at + basis(1) * stride));
    } else
      return along<k, g_>(d, at);
  }
  template <typename Mask, typename V>
  static HWY_INLINE Pair<V> masked(const Mask &mask, const Pair<V> &v, int k)
  {
    return {mask(v.x, k), mask(v.y, k)};
  }

  /// a where bond k carries, b elsewhere.
  template <typename Mask, typename V>
  static HWY_INLINE Pair<V> where_carries(const Mask &mask, int k, const Pair<V> &a,
                                          const Pair<V> &b)
  {
    return {mask.select(a.x, b.x, k), mask.select(a.y, b.y, k)};
  }

  // First streams: displacement, angle, h and g, sum of a x Du, pressure beside the lattice's; of
  // inelastic ones own torque in place of the sum, and g of two directions.
  static constexpr int u_ = 0, angle_ = 2, h_ = 3, g_ = 5, moment_ = 7, other_ = 8;
  static constexpr int basis(int k) { return k == 0 ? g_ : other_; }

  LatticeArrays<2> a_;
  LatticeConstants<2> c_;
  LatticeBonds law_;
  bool volumetric_;
  const InelasticSweep<2> *inelastic_sweep_;
  double third_;        // the third normal is the second one plus or minus the first
  double *w_ = nullptr; // origin of the window
};

template <int n_dir, bool inelastic>
void sweep_rows_of(const RowSweep<2> &sweep)
{
  if (2 * sweep.window_length() <= RowWindow::close)
    RowPipeline<Bonds2d<n_dir, RowWindow::close, inelastic>, 2>(sweep).run();
  else
    RowPipeline<Bonds2d<n_dir, RowWindow::wide, inelastic>, 2>(sweep).run();
}

template <bool inelastic>
void sweep_rows_of(const RowSweep<2> &sweep)
{
  if (sweep.constants.n_directions == 2)
    sweep_rows_of<2, inelastic>(sweep);
  else
    sweep_rows_of<3, inelastic>(sweep);
}

void sweep_rows_2d(const RowSweep<2> &sweep)
{
  if (sweep.inelastic)
    sweep_rows_of<true>(sweep);
  else
    sweep_rows_of<false>(sweep);
}

void sines(const double *angle, double *cosine_minus_1, double *sine, int n)
{
  for_each_vector(0, 0, n, [&](auto d, long i) HWY_ATTR {
    hn::Vec<decltype(d)> c, s;
    cosine_minus_1_and_sine(d, hn::LoadU(d, angle + i), c, s);
    hn::StoreU(c, d, cosine_minus_1 + i);
    hn::StoreU(s, d, sine + i);
  });
}
} // namespace ligament::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ligament::dem
{
HWY_EXPORT(sweep_rows_2d);
HWY_EXPORT(sines);

void sweep_rows(const RowSweep<2> &sweep)
{
  HWY_DYNAMIC_DISPATCH(sweep_rows_2d)(sweep);
}

void cosine_minus_1_and_sine(const double *angle, double *cosine_minus_1, double *sine, int n)
{
  HWY_DYNAMIC_DISPATCH(sines)(angle, cosine_minus_1, sine, n);
}
} // namespace ligament::dem
#endif
