// Compiled once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dem/lattice_kernel_2d.cc"
#include "dem/dispatch.h"

#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway wants it.
#include "dem/lattice_rows.h"
#include "dem/sine.h"

HWY_BEFORE_NAMESPACE();
namespace ligament::dem::HWY_NAMESPACE
{
/// Two components of a vector of particles.
template <typename V>
struct Pair
{
  V x, y;

  friend HWY_INLINE Pair operator+(const Pair &a, const Pair &b)
  {
    return {hn::Add(a.x, b.x), hn::Add(a.y, b.y)};
  }
  friend HWY_INLINE Pair operator-(const Pair &a, const Pair &b)
  {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y)};
  }
};

/// s a + b
template <typename V>
HWY_INLINE Pair<V> mul_add(V s, const Pair<V> &a, const Pair<V> &b)
{
  return {hn::MulAdd(s, a.x, b.x), hn::MulAdd(s, a.y, b.y)};
}
/// b - s a
template <typename V>
HWY_INLINE Pair<V> neg_mul_add(V s, const Pair<V> &a, const Pair<V> &b)
{
  return {hn::NegMulAdd(s, a.x, b.x), hn::NegMulAdd(s, a.y, b.y)};
}
/// c + a . b
template <typename V>
HWY_INLINE V add_dot(const Pair<V> &a, const Pair<V> &b, V c)
{
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, c));
}
/// c + a x b
template <typename V>
HWY_INLINE V add_cross(const Pair<V> &a, const Pair<V> &b, V c)
{
  return hn::MulAdd(a.x, b.y, hn::NegMulAdd(a.y, b.x, c));
}

/// theory.md eqs. (D4), (D6), (D8b) for vectors of particles that are neighbours in a row. With
/// h = (R - I) n and v = q S/r, the force on a face is
///   S t = 2G S/r (u_j - u_i) + (g_i + g_j), g = v p n + (v p - 2G S/r q) h,
/// formed by the same operations from either end, so that pair forces cancel exactly. Kept of each
/// particle are the two numbers of h and of g along n and along its normal.
template <int n_dir>
class Bonds2d
{
public:
  static constexpr int n_directions = n_dir;
  static constexpr int n_streams = 5;
  using Offsets = NeighbourOffsets<n_dir>;

  HWY_INLINE explicit Bonds2d(const RowSweep<2> &sweep)
      : a_(sweep.arrays), c_(sweep.constants), volumetric_(sweep.volumetric)
  {
  }

  HWY_INLINE void set_window(RowWindow &window)
  {
    h_ = {window.stream(0), window.stream(1)};
    g_ = {window.stream(2), window.stream(3)};
    moment_ = window.stream(4);
  }

  template <typename D>
  HWY_INLINE void turn(D d, long i) const
  {
    hn::Vec<D> c, s;
    cosine_minus_1_and_sine(d, hn::LoadU(d, a_.rotation[0] + i), c, s);
    store(d, {c, s}, h_.data(), i);
    if (!volumetric_) {
      const auto factor = hn::Set(d, -c_.shear * c_.half);
      store(d, {hn::Mul(factor, c), hn::Mul(factor, s)}, g_.data(), i);
    }
  }

  template <bool full, typename D>
  HWY_INLINE void dilatation(D d, long i, const Offsets &offsets) const
  {
    const BondMask<D, full> mask(d, a_.mask, i);
    auto theta = hn::Zero(d), moment = hn::Zero(d);
    const auto u = displacement(d, i);
    for_directions([&](auto direction) HWY_ATTR {
      constexpr int k = decltype(direction)::value;
      const long f = i + offsets.forward[k], b = i + offsets.backward[k];
      const auto half = hn::Set(d, c_.half);
      const auto h = along<k>(d, h_, i);
      auto forward = neg_mul_add(half, h + along<k>(d, h_, f), displacement(d, f) - u);
      auto backward = neg_mul_add(half, along<k>(d, h_, b) + h, u - displacement(d, b));
      const auto e = masked(mask, forward, k) + masked(mask, backward, n_dir + k);
      const auto a = normal(d, k) + h;
      theta = add_dot(a, e, theta);
      moment = add_cross(a, e, moment);
    });
    const double volumetric = c_.area_r * c_.half;
    const auto share = hn::Mul(hn::Set(d, volumetric), hn::LoadU(d, a_.lambda_per_volume + i));
    const auto p = hn::MulAdd(share, theta, hn::LoadU(d, a_.other_pressure + i));
    hn::StoreU(p, d, a_.pressure + i);
    hn::StoreU(moment, d, moment_ + i);
    const auto vp = hn::Mul(hn::Set(d, volumetric), p);
    const auto factor = hn::Sub(vp, hn::Set(d, c_.shear * c_.half));
    const auto h = load(d, h_.data(), i);
    store(d, {hn::MulAdd(factor, h.x, vp), hn::Mul(factor, h.y)}, g_.data(), i);
  }

  /// True when the force on a face, in any direction, reaches the strength.
  template <bool full, typename D>
  HWY_INLINE bool forces(D d, long i, const Offsets &offsets) const
  {
    using V = hn::Vec<D>;
    const BondMask<D, full> mask(d, a_.mask, i);
    const V zero = hn::Zero(d);
    Pair<V> force{zero, zero};
    V torque = zero, bend = zero, largest = zero;
    const auto u = displacement(d, i);
    const V angle = hn::LoadU(d, a_.rotation[0] + i);
    for_directions([&](auto direction) HWY_ATTR {
      constexpr int k = decltype(direction)::value;
      const long f = i + offsets.forward[k], b = i + offsets.backward[k];
      const auto shear = hn::Set(d, c_.shear);
      const auto g = along<k>(d, g_, i);
      const auto t_f =
          masked(mask, mul_add(shear, displacement(d, f) - u, g + along<k>(d, g_, f)), k);
      const auto t_b =
          masked(mask, mul_add(shear, u - displacement(d, b), along<k>(d, g_, b) + g), n_dir + k);
      force = force + (t_f - t_b);
      torque = add_cross(normal(d, k) + along<k>(d, h_, i), t_f + t_b, torque);
      largest = hn::Max(largest, add_dot(t_f, t_f, zero));
      bend = hn::Add(bend,
                     hn::Sub(mask(hn::Sub(hn::LoadU(d, a_.rotation[0] + f), angle), k),
                             mask(hn::Sub(angle, hn::LoadU(d, a_.rotation[0] + b)), n_dir + k)));
    });
    torque = hn::Mul(hn::Set(d, c_.half), torque);
    if (volumetric_)
      torque = hn::NegMulAdd(
          hn::Mul(hn::Set(d, c_.half * c_.area_r), hn::LoadU(d, a_.pressure + i)),
          hn::LoadU(d, moment_ + i), torque);
    torque = hn::MulAdd(hn::Set(d, c_.bending), bend, torque);
    store(d, force, a_.force.data(), i);
    hn::StoreU(torque, d, a_.torque[0] + i);
    return !hn::AllFalse(d, hn::Ge(largest, hn::Set(d, c_.limit2)));
  }

  /// True when the tension along the present normal of a forward face reaches the strength.
  template <bool full, typename D>
  HWY_INLINE bool exceeds(D d, long i, const Offsets &offsets) const
  {
    const BondMask<D, full> mask(d, a_.mask, i);
    const auto zero = hn::Zero(d);
    auto found = hn::Lt(zero, zero);
    const auto u = displacement(d, i);
    for_directions([&](auto direction) HWY_ATTR {
      constexpr int k = decltype(direction)::value;
      const long f = i + offsets.forward[k];
      const auto t = masked(mask,
                            mul_add(hn::Set(d, c_.shear), displacement(d, f) - u,
                                    along<k>(d, g_, i) + along<k>(d, g_, f)),
                            k);
      const auto n = normal(d, k);
      const auto mean = (n + n) + (along<k>(d, h_, i) + along<k>(d, h_, f));
      const auto tension = add_dot(t, mean, zero);
      const auto limit = hn::Mul(hn::Set(d, c_.limit2), add_dot(mean, mean, zero));
      found = hn::Or(found, hn::Ge(hn::Mul(tension, hn::Abs(tension)), limit));
    });
    return !hn::AllFalse(d, found);
  }

private:
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

  template <typename D, typename Pointer>
  static HWY_INLINE Pair<hn::Vec<D>> load(D d, Pointer const *streams, long i)
  {
    return {hn::LoadU(d, streams[0] + i), hn::LoadU(d, streams[1] + i)};
  }
  template <typename D>
  static HWY_INLINE void store(D d, const Pair<hn::Vec<D>> &v, double *const *streams, long i)
  {
    hn::StoreU(v.x, d, streams[0] + i);
    hn::StoreU(v.y, d, streams[1] + i);
  }
  template <typename D>
  HWY_INLINE Pair<hn::Vec<D>> displacement(D d, long i) const
  {
    return load(d, a_.displacement.data(), i);
  }
  template <typename D>
  HWY_INLINE Pair<hn::Vec<D>> normal(D d, int k) const
  {
    return {hn::Set(d, c_.normal[k][0]), hn::Set(d, c_.normal[k][1])};
  }
  /// The vector whose parts along the normal of direction k and across it are kept.
  template <int k, typename D>
  HWY_INLINE Pair<hn::Vec<D>> along(D d, const std::array<double *, 2> &streams, long i) const
  {
    const auto part = load(d, streams.data(), i);
    const auto n = normal(d, k);
    return {hn::NegMulAdd(part.y, n.y, hn::Mul(part.x, n.x)),
            hn::MulAdd(part.y, n.x, hn::Mul(part.x, n.y))};
  }
  template <typename Mask, typename V>
  static HWY_INLINE Pair<V> masked(const Mask &mask, const Pair<V> &v, int k)
  {
    return {mask(v.x, k), mask(v.y, k)};
  }

  LatticeArrays<2> a_;
  LatticeConstants<2> c_;
  bool volumetric_;
  std::array<double *, 2> h_, g_; // parts along n and across it
  double *moment_;                // sum of a x Du
};

void sweep_rows_2d(const RowSweep<2> &sweep)
{
  if (sweep.constants.n_directions == 2)
    RowPipeline<Bonds2d<2>, 2>(sweep).run();
  else
    RowPipeline<Bonds2d<3>, 2>(sweep).run();
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
