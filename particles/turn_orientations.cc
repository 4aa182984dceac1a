// Compiled once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "particles/turn_orientations.cc"
#include "particles/turn_orientations.h"
#include "core/dispatch.h"

#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway wants it.
#include <hwy/highway.h>

#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace ligament::particles::HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// cos(x) and sin(x)/x of x^2: by their series, since half angles are far below one per step; the
/// rare others one by one.
template <typename D>
HWY_INLINE void half_angle(D d, hn::Vec<D> x2, hn::Vec<D> &cosine, hn::Vec<D> &sine_by_x)
{
  const auto one = hn::Set(d, 1.);
  const auto c2 = hn::NegMulAdd(x2, hn::Set(d, 1 / 30.), one);
  const auto c4 = hn::NegMulAdd(hn::Mul(x2, hn::Set(d, 1 / 12.)), c2, one);
  cosine = hn::NegMulAdd(hn::Mul(x2, hn::Set(d, 1 / 2.)), c4, one);
  const auto s3 = hn::NegMulAdd(x2, hn::Set(d, 1 / 20.), one);
  sine_by_x = hn::NegMulAdd(hn::Mul(x2, hn::Set(d, 1 / 6.)), s3, one);
  constexpr double series_limit = 1e-4; // the first terms left out are below 1e-17
  if (HWY_LIKELY(hn::AllTrue(d, hn::Lt(x2, hn::Set(d, series_limit)))))
    return;
  constexpr std::size_t n = hn::MaxLanes(D());
  double square[n], c[n], s[n];
  hn::StoreU(x2, d, square);
  hn::StoreU(cosine, d, c);
  hn::StoreU(sine_by_x, d, s);
  for (std::size_t i = 0; i < n; ++i)
    if (!(square[i] < series_limit)) {
      const double x = std::sqrt(square[i]);
      c[i] = std::cos(x);
      s[i] = std::sin(x) / x;
    }
  cosine = hn::LoadU(d, c);
  sine_by_x = hn::LoadU(d, s);
}

template <typename D>
HWY_INLINE void turn(D d, const std::array<double *, 4> &q, const std::array<const double *, 3> &w,
                     double dt, long i)
{
  const auto half = hn::Set(d, dt / 2);
  const auto bx = hn::Mul(half, hn::LoadU(d, w[0] + i)), by = hn::Mul(half, hn::LoadU(d, w[1] + i)),
             bz = hn::Mul(half, hn::LoadU(d, w[2] + i));
  const auto x2 = hn::MulAdd(bx, bx, hn::MulAdd(by, by, hn::Mul(bz, bz)));
  hn::Vec<D> c, s;
  half_angle(d, x2, c, s);
  const auto ex = hn::Mul(s, bx), ey = hn::Mul(s, by), ez = hn::Mul(s, bz);
  const auto w0 = hn::LoadU(d, q[0] + i), x0 = hn::LoadU(d, q[1] + i), y0 = hn::LoadU(d, q[2] + i),
             z0 = hn::LoadU(d, q[3] + i);
  const auto w1 =
      hn::NegMulAdd(ex, x0, hn::NegMulAdd(ey, y0, hn::NegMulAdd(ez, z0, hn::Mul(c, w0))));
  const auto x1 = hn::MulAdd(c, x0, hn::MulAdd(ex, w0, hn::NegMulAdd(ez, y0, hn::Mul(ey, z0))));
  const auto y1 = hn::MulAdd(c, y0, hn::MulAdd(ey, w0, hn::NegMulAdd(ex, z0, hn::Mul(ez, x0))));
  const auto z1 = hn::MulAdd(c, z0, hn::MulAdd(ez, w0, hn::NegMulAdd(ey, x0, hn::Mul(ex, y0))));
  // First-order renormalisation keeps |q| = 1 against round-off.
  const auto square = hn::MulAdd(w1, w1, hn::MulAdd(x1, x1, hn::MulAdd(y1, y1, hn::Mul(z1, z1))));
  const auto norm = hn::NegMulAdd(hn::Set(d, 0.5), square, hn::Set(d, 1.5));
  hn::StoreU(hn::Mul(w1, norm), d, q[0] + i);
  hn::StoreU(hn::Mul(x1, norm), d, q[1] + i);
  hn::StoreU(hn::Mul(y1, norm), d, q[2] + i);
  hn::StoreU(hn::Mul(z1, norm), d, q[3] + i);
}

void turn_all(const std::array<double *, 4> &quaternion, const std::array<const double *, 3> &spin,
              double dt, int n)
{
  const hn::ScalableTag<double> d;
  const int lanes = int(hn::Lanes(d));
  int i = 0;
  for (; i + lanes <= n; i += lanes)
    turn(d, quaternion, spin, dt, i);
  for (; i < n; ++i)
    turn(hn::CappedTag<double, 1>(), quaternion, spin, dt, i);
}
} // namespace ligament::particles::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ligament::particles
{
HWY_EXPORT(turn_all);

void turn_orientations(const std::array<double *, 4> &quaternion,
                       const std::array<const double *, 3> &spin, double dt, int n)
{
  HWY_DYNAMIC_DISPATCH(turn_all)(quaternion, spin, dt, n);
}
} // namespace ligament::particles
#endif
