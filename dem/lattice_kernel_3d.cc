// Compiled once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dem/lattice_kernel_3d.cc"
#include "core/dispatch.h"

#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway wants it.
#include "dem/inelastic/response.h"
#include "dem/lane_vectors.h"
#include "dem/lattice_rows.h"
#include "dem/laws/bending.h"
#include "dem/laws/elastic_bond.h"
#include "dem/stress_bound.h"

HWY_BEFORE_NAMESPACE();
namespace ligament::dem::HWY_NAMESPACE
{
/// Directions as sums of three of them, whose turned normals are all that is kept of a rotation.
template <int n_dir>
struct Basis;
template <>
struct Basis<3>
{
  static constexpr int direction[3] = {0, 1, 2};
  static constexpr int part[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
};
template <>
struct Basis<6>
{
  static constexpr int direction[3] = {0, 1, 5};
  static constexpr int part[6][3] = {{1, 0, 0},  {0, 1, 0},  {-1, -1, 1},
                                     {0, -1, 1}, {-1, 0, 1}, {0, 0, 1}};
};

/// R - I of a quaternion.
template <typename V>
struct Change
{
  Triple<V> x, y, z; // columns

  HWY_INLINE explicit Change(const Quaternion<V> &q)
  {
    const auto &v = q.v;
    const Triple<V> two = v + v;
    const V xx = hn::Mul(two.x, v.x), yy = hn::Mul(two.y, v.y), zz = hn::Mul(two.z, v.z);
    const V xy = hn::Mul(two.x, v.y), xz = hn::Mul(two.x, v.z), yz = hn::Mul(two.y, v.z);
    const V wx = hn::Mul(two.x, q.w), wy = hn::Mul(two.y, q.w), wz = hn::Mul(two.z, q.w);
    x = {hn::Neg(hn::Add(yy, zz)), hn::Add(xy, wz), hn::Sub(xz, wy)};
    y = {hn::Sub(xy, wz), hn::Neg(hn::Add(xx, zz)), hn::Add(yz, wx)};
    z = {hn::Add(xz, wy), hn::Sub(yz, wx), hn::Neg(hn::Add(xx, yy))};
  }
  HWY_INLINE Triple<V> of(const Triple<V> &a) const
  {
    return mul_add(a.x, x, mul_add(a.y, y, a.z * z));
  }
  /// (R^T - I) a
  HWY_INLINE Triple<V> of_inverse(const Triple<V> &a) const
  {
    return {dot(x, a), dot(y, a), dot(z, a)};
  }
};

/// theory.md eqs. (D4), (D6), (D8b), (D8c) for vectors of particles that are neighbours in a row.
/// With h = (R - I) n and v = q S/r, the force on a face is
///   S t = 2G S/r (u_j - u_i) + (g_i + g_j), g = v p n + (v p - 2G S/r q) h:
/// linear in h, which three directions give for all, and formed by the same operations from either
/// end, so that pair forces cancel exactly. Strains of their own take 2G S/r q R e n from g,
/// eq. (D22).
template <int n_dir, long stride_, bool inelastic_>
class Bonds3d
{
public:
  static constexpr long stride = stride_;
  static constexpr bool inelastic = inelastic_;
  static constexpr int n_streams = 29;
  using Offsets = NeighbourOffsets<n_dir>;

  HWY_INLINE explicit Bonds3d(const RowSweep<3> &sweep)
      : a_(sweep.arrays),
        c_(sweep.constants), law_{c_.shear, c_.half, c_.shear * c_.half, c_.area_r * c_.half},
        volumetric_(sweep.volumetric), inelastic_sweep_(sweep.inelastic)
  {
  }

  HWY_INLINE void set_window(double *origin) { w_ = origin; }

  template <typename D>
  HWY_INLINE void turn(D d, long i) const
  {
    prefetch(a_.displacement, i);
    prefetch(a_.rotation, i);
    double *const at = w_ + i;
    for (int c = 0; c < 3; ++c)
      hn::StoreU(hn::LoadU(d, a_.displacement[c] + i), d, at + (u_ + c) * stride);
    for (int c = 0; c < 4; ++c)
      hn::StoreU(hn::LoadU(d, a_.rotation[c] + i), d, at + (q_ + c) * stride);
    const auto q = quaternion(d, at);
    if (volumetric_ && !inelastic)
      hn::StoreU(hn::Zero(d), d, at + other_ * stride);
    const Change<hn::Vec<D>> change(q);
    for (int m = 0; m < 3; ++m) {
      const auto n = normal(d, Basis<n_dir>::direction[m]);
      const auto h = change.of(n);
      store(d, h, at + (h_ + 3 * m) * stride);
      if (!volumetric_)
        store(d, law_.part(h), at + (g_ + 3 * m) * stride);
    }
  }

  /// After turn() of the particle.
  HWY_INLINE void take_other_pressure(int i) const { w_[other_ * stride + i] = a_.pressure[i]; }

  template <typename D>
  HWY_INLINE void dilatation(D d, long i, const Offsets &offsets) const
  {
    prefetch(std::array{a_.lambda_per_volume, static_cast<const double *>(a_.pressure)}, i);
    const BondMask<D> mask(d, a_.mask, i);
    const auto zero = hn::Zero(d);
    auto theta = zero;
    Triple<hn::Vec<D>> moment{zero, zero, zero};
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
    store(d, moment, at + moment_ * stride);
    const auto vp = law_.pressing(p);
    for (int m = 0; m < 3; ++m)
      store(
          d,
          law_.part(vp, normal(d, Basis<n_dir>::direction[m]), load(d, at + (h_ + 3 * m) * stride)),
          at + (g_ + 3 * m) * stride);
  }

  /// The same of particles with strains of their own, which flow behind `done`.
  template <typename D>
  HWY_INLINE void strain(D d, long i, const Offsets &offsets, int done) const
  {
    using V = hn::Vec<D>;
    using V3 = Triple<V>;
    const InARow<3, D> place{i};
    prefetch(std::array{a_.lambda_per_volume, static_cast<const double *>(a_.pressure)}, i);
    place.prefetch(a_.mask);
    place.prefetch(inelastic_sweep_->open);
    const BondMask<D> mask(d, a_.mask, i);
    const V zero = hn::Zero(d);
    double *const at = w_ + i;
    const auto u = displacement(d, at);
    // Sum of Du (x) n, column by column.
    V3 sum[3] = {{zero, zero, zero}, {zero, zero, zero}, {zero, zero, zero}};
    const auto add = [&](const V3 &both, int k) HWY_ATTR {
      const auto n = normal(d, k);
      sum[0] = mul_add(n.x, both, sum[0]);
      sum[1] = mul_add(n.y, both, sum[1]);
      sum[2] = mul_add(n.z, both, sum[2]);
    };
    // Whole vectors without the masks, with the same bits.
    if (HWY_LIKELY(hn::AllTrue(d, mask.all(2 * n_dir))))
      for_directions([&](auto direction) HWY_ATTR {
        constexpr int k = decltype(direction)::value;
        const double *const f = at + offsets.forward[k], *const b = at + offsets.backward[k];
        const auto own = along<k, h_>(d, at);
        const auto around = (along<k, h_>(d, f) + own) + (along<k, h_>(d, b) + own);
        add(law_.relative(displacement(d, f) - displacement(d, b), around), k);
      });
    else
      for_directions([&](auto direction) HWY_ATTR {
        constexpr int k = decltype(direction)::value;
        const double *const f = at + offsets.forward[k], *const b = at + offsets.backward[k];
        const auto own = along<k, h_>(d, at);
        const auto around = masked(mask, along<k, h_>(d, f) + own, k) +
                            masked(mask, along<k, h_>(d, b) + own, n_dir + k);
        const auto apart = where_carries(mask, k, displacement(d, f), u) -
                           where_carries(mask, n_dir + k, displacement(d, b), u);
        add(law_.relative(apart, around), k);
      });
    const Change<V> change(quaternion(d, at));
    V theta = hn::Add(sum[0].x, hn::Add(sum[1].y, sum[2].z));
    theta = add_dot(change.x, sum[0], add_dot(change.y, sum[1], add_dot(change.z, sum[2], theta)));
    const V factor = hn::Set(d, law_.volumetric);
    theta = hn::Mul(factor, theta);
    V3 moment{hn::Sub(sum[1].z, sum[2].y), hn::Sub(sum[2].x, sum[0].z),
              hn::Sub(sum[0].y, sum[1].x)}; // a x Du
    moment = add_cross(change.x, sum[0],
                       add_cross(change.y, sum[1], add_cross(change.z, sum[2], moment)));
    const V lambda_per_volume = hn::LoadU(d, a_.lambda_per_volume + i);
    Answer<3, V> response(zero_tensor<3>(zero), hn::Mul(lambda_per_volume, theta), false);
    const double per_volume = law_.volumetric * inelastic_sweep_->per_whole_volume;
    const V square = hn::Mul(hn::Set(d, per_volume * per_volume),
                             add_dot(sum[0], sum[0], add_dot(sum[1], sum[1], dot(sum[2], sum[2]))));
    V x[3][3]; // R^T sum times S q / r
    for (auto &row : x)
      for (V &number : row)
        number = zero;
    if (!is_quiet<3>(d, *inelastic_sweep_, place, square)) {
      for (int b = 0; b < 3; ++b) {
        const V3 own = factor * (sum[b] + change.of_inverse(sum[b]));
        x[0][b] = own.x, x[1][b] = own.y, x[2][b] = own.z;
      }
      const auto fresh = hn::Not(hn::FirstN(d, std::size_t(std::max(done - i, 0L))));
      response = respond<3>(d, *inelastic_sweep_, place, fresh, x, theta, lambda_per_volume);
    }
    const V p = response.pressure, vp = law_.pressing(p);
    hn::StoreU(p, d, a_.pressure + i);
    const V shear_half = hn::Set(d, law_.shear_half);
    const auto &e = response.strain;
    V3 torque = hn::Neg(vp) * moment;
    if (response.is_strained) {
      const V modulus = hn::Set(d, law_.shear_half / law_.volumetric); // 2G
      const auto y = [&](int a, int b) HWY_ATTR {                      // X e
        return hn::MulAdd(x[a][0], e(0, b),
                          hn::MulAdd(x[a][1], e(1, b), hn::Mul(x[a][2], e(2, b))));
      };
      const V3 own = modulus * V3{hn::Sub(y(2, 1), y(1, 2)), hn::Sub(y(0, 2), y(2, 0)),
                                  hn::Sub(y(1, 0), y(0, 1))};
      torque = torque + (own + change.of(own));
    }
    store(d, torque, at + moment_ * stride);
    for (int m = 0; m < 3; ++m) {
      const auto n = normal(d, Basis<n_dir>::direction[m]);
      V3 g = law_.part(vp, n, load(d, at + (h_ + 3 * m) * stride));
      if (response.is_strained) {
        const auto row = [&](int a) HWY_ATTR {
          return hn::MulAdd(e(a, 0), n.x, hn::MulAdd(e(a, 1), n.y, hn::Mul(e(a, 2), n.z)));
        };
        const V3 en{row(0), row(1), row(2)};
        g = neg_mul_add(shear_half, en + change.of(en), g);
      }
      store(d, g, at + (g_ + 3 * m) * stride);
    }
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
    Triple<V> force{zero, zero, zero}, torque{zero, zero, zero};
    LatticeBending<V> bending(zero);
    V largest = zero; // by particle: twice the sum of all forces^2
    StressSum3d<V> stress(d);
    double *const at = w_ + i;
    const auto u = displacement(d, at);
    const auto q = quaternion(d, at);
    for_directions([&](auto direction) HWY_ATTR {
      constexpr int k = decltype(direction)::value;
      const double *const f = at + offsets.forward[k], *const b = at + offsets.backward[k];
      const auto g = along<k, g_>(d, at), n = normal(d, k);
      const auto t_f = masked(mask, law_.force(displacement(d, f) - u, g + along<k, g_>(d, f)), k);
      const auto t_b =
          masked(mask, law_.force(u - displacement(d, b), along<k, g_>(d, b) + g), n_dir + k);
      const auto net = t_f - t_b, both = t_f + t_b, a = n + along<k, h_>(d, at);
      force = force + net;
      torque = add_cross(a, both, torque);
      if constexpr (by_particle) {
        stress.add(a, both);
        largest = add_dot(net, net, add_dot(both, both, largest));
      } else
        largest = hn::Max(largest, add_dot(t_f, t_f, zero));

      bending.add(
          q, n, quaternion(d, f), [&](V v) HWY_ATTR { return mask(v, k); }, quaternion(d, b),
          [&](V v) HWY_ATTR { return mask(v, n_dir + k); });
    });
    const auto look = [&]() HWY_ATTR {
      if constexpr (by_particle) {
        const V angle = hn::Sqrt(hn::Mul(hn::Set(d, 4.1), add_dot(q.v, q.v, zero))); // or more
        return not_cleared<n_dir, 3>(d, c_, mask, angle, stress, torque, largest);
      } else
        return hn::Ge(largest, hn::Set(d, c_.limit2));
    }();
    torque = law_.torque(torque);
    if constexpr (inelastic)
      torque = torque + load(d, at + moment_ * stride);
    else if (volumetric_)
      torque = law_.add_torque_of_pressure(hn::LoadU(d, a_.pressure + i),
                                           load(d, at + moment_ * stride), torque);
    torque = bending.add_torque(q, hn::Set(d, 2 * c_.bending), hn::Set(d, 2 * c_.twist), torque);
    hn::StoreU(force.x, d, a_.force[0] + i);
    hn::StoreU(force.y, d, a_.force[1] + i);
    hn::StoreU(force.z, d, a_.force[2] + i);
    hn::StoreU(torque.x, d, a_.torque[0] + i);
    hn::StoreU(torque.y, d, a_.torque[1] + i);
    hn::StoreU(torque.z, d, a_.torque[2] + i);
    return look;
  }

  /// Of the forward bonds.
  template <typename D>
  HWY_INLINE hn::Vec<D> energy(D d, long i, const Offsets &offsets) const
  {
    const BondMask<D> mask(d, a_.mask, i);
    const auto zero = hn::Zero(d);
    auto du2 = zero, v2 = zero, vn2 = zero;
    double *const at = w_ + i;
    const auto u = displacement(d, at);
    const auto q = quaternion(d, at);
    for_directions([&](auto direction) HWY_ATTR {
      constexpr int k = decltype(direction)::value;
      const double *const f = at + offsets.forward[k];
      const auto h = along<k, h_>(d, at) + along<k, h_>(d, f);
      const auto du = masked(mask, law_.relative(displacement(d, f) - u, h), k);
      const auto q_f = quaternion(d, f);
      const auto v = masked(mask, relative_turn(q.w, q.v, q_f.w, q_f.v), k);
      const auto vn = add_dot(v, normal(d, k), zero);
      du2 = add_dot(du, du, du2);
      v2 = add_dot(v, v, v2);
      vn2 = hn::MulAdd(vn, vn, vn2);
    });
    const SpaceBending<hn::Vec<D>> bending{hn::Set(d, c_.bending), hn::Set(d, c_.twist)};
    const auto half =
        bending.add_half_energy(v2, vn2, hn::Mul(hn::Set(d, 0.25), law_.twice_energy(du2)));
    return hn::Add(half, half);
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
  /// Of the face in direction k between two particles, bit `bit` of the mask.
  template <int k, typename D>
  HWY_INLINE hn::Mask<D> face_reaches(D d, const BondMask<D> &mask, int bit, const double *from,
                                      const double *to) const
  {
    const auto t = masked(mask,
                          law_.force(displacement(d, to) - displacement(d, from),
                                     along<k, g_>(d, from) + along<k, g_>(d, to)),
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

  /// Three streams from one on.
  template <typename D>
  static HWY_INLINE Triple<hn::Vec<D>> load(D d, const double *p)
  {
    return {hn::LoadU(d, p), hn::LoadU(d, p + stride), hn::LoadU(d, p + 2 * stride)};
  }
  template <typename D>
  static HWY_INLINE void store(D d, const Triple<hn::Vec<D>> &v, double *p)
  {
    hn::StoreU(v.x, d, p);
    hn::StoreU(v.y, d, p + stride);
    hn::StoreU(v.z, d, p + 2 * stride);
  }
  template <typename D>
  static HWY_INLINE Triple<hn::Vec<D>> displacement(D d, const double *at)
  {
    return load(d, at + u_ * stride);
  }
  template <typename D>
  static HWY_INLINE Quaternion<hn::Vec<D>> quaternion(D d, const double *at)
  {
    return {hn::LoadU(d, at + q_ * stride), load(d, at + (q_ + 1) * stride)};
  }
  template <typename D>
  HWY_INLINE Triple<hn::Vec<D>> normal(D d, int k) const
  {
    const auto &n = c_.normal[k];
    return {hn::Set(d, n[0]), hn::Set(d, n[1]), hn::Set(d, n[2])};
  }
  /// The vector of direction k out of those of the basis, whose streams start at `first`.
  template <int k, int first, typename D>
  static HWY_INLINE Triple<hn::Vec<D>> along(D d, const double *at)
  {
    constexpr auto &part = Basis<n_dir>::part[k];
    constexpr int positive = part[2] == 1 ? 2 : part[1] == 1 ? 1 : 0;
    const double *const p = at + first * stride;
    auto sum = load(d, p + 3 * positive * stride);
    if (part[0] == -1)
      sum = sum - load(d, p);
    if (part[1] == -1)
      sum = sum - load(d, p + 3 * stride);
    return sum;
  }
  template <typename Mask, typename V>
  static HWY_INLINE Triple<V> masked(const Mask &mask, const Triple<V> &v, int k)
  {
    return {mask(v.x, k), mask(v.y, k), mask(v.z, k)};
  }

  /// a where bond k carries, b elsewhere.
  template <typename Mask, typename V>
  static HWY_INLINE Triple<V> where_carries(const Mask &mask, int k, const Triple<V> &a,
                                            const Triple<V> &b)
  {
    return {mask.select(a.x, b.x, k), mask.select(a.y, b.y, k), mask.select(a.z, b.z, k)};
  }

  // First streams: displacement, quaternion, h and g of the basis, sum of a x Du (inelastic: own
  // torque), pressure beside the lattice's.
  static constexpr int u_ = 0, q_ = 3, h_ = 7, g_ = 16, moment_ = 25, other_ = 28;

  LatticeArrays<3> a_;
  LatticeConstants<3> c_;
  LatticeBonds law_;
  bool volumetric_;
  const InelasticSweep<3> *inelastic_sweep_;
  double *w_ = nullptr; // origin of the window
};

template <int n_dir, bool inelastic>
void sweep_rows_of(const RowSweep<3> &sweep)
{
  if (2 * sweep.window_length() <= RowWindow::close)
    RowPipeline<Bonds3d<n_dir, RowWindow::close, inelastic>, 3>(sweep).run();
  else
    RowPipeline<Bonds3d<n_dir, RowWindow::wide, inelastic>, 3>(sweep).run();
}

template <bool inelastic>
void sweep_rows_of(const RowSweep<3> &sweep)
{
  if (sweep.constants.n_directions == 3)
    sweep_rows_of<3, inelastic>(sweep);
  else
    sweep_rows_of<6, inelastic>(sweep);
}

void sweep_rows_3d(const RowSweep<3> &sweep)
{
  if (sweep.inelastic)
    sweep_rows_of<true>(sweep);
  else
    sweep_rows_of<false>(sweep);
}
} // namespace ligament::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ligament::dem
{
HWY_EXPORT(sweep_rows_3d);

void sweep_rows(const RowSweep<3> &sweep)
{
  HWY_DYNAMIC_DISPATCH(sweep_rows_3d)(sweep);
}
} // namespace ligament::dem
#endif
