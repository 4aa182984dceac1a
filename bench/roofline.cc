// Compiled once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/roofline.cc"
#include "bench/roofline.h"
#include "core/dispatch.h"

#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway wants it.
#include <hwy/highway.h>

#include <vector>

HWY_BEFORE_NAMESPACE();
namespace ligament::bench::HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// Twelve independent chains hide the latency. Returns a number that depends on all.
double multiply_add(long n)
{
  const hn::ScalableTag<double> d;
  const auto x = hn::Set(d, 0.999999), y = hn::Set(d, 1e-7);
  // All different: equal chains would be computed once.
  auto a = hn::Iota(d, 1.), b = hn::Add(a, x), c = hn::Add(b, x), e = hn::Add(c, x),
       f = hn::Add(e, x), g = hn::Add(f, x), h = hn::Add(g, x), i = hn::Add(h, x),
       j = hn::Add(i, x), k = hn::Add(j, x), l = hn::Add(k, x), m = hn::Add(l, x);
  for (long step = 0; step < n; ++step) {
    a = hn::MulAdd(a, x, y), b = hn::MulAdd(b, x, y), c = hn::MulAdd(c, x, y);
    e = hn::MulAdd(e, x, y), f = hn::MulAdd(f, x, y), g = hn::MulAdd(g, x, y);
    h = hn::MulAdd(h, x, y), i = hn::MulAdd(i, x, y), j = hn::MulAdd(j, x, y);
    k = hn::MulAdd(k, x, y), l = hn::MulAdd(l, x, y), m = hn::MulAdd(m, x, y);
  }
  for (const auto &v : {b, c, e, f, g, h, i, j, k, l, m})
    a = hn::Add(a, v);
  return hn::GetLane(hn::SumOfLanes(d, a));
}

long lanes()
{
  return long(hn::Lanes(hn::ScalableTag<double>()));
}

void triad(double *a, const double *b, const double *c, long n)
{
  const hn::ScalableTag<double> d;
  const auto s = hn::Set(d, 3.);
  for (long i = 0; i < n; i += lanes())
    hn::StoreU(hn::MulAdd(s, hn::LoadU(d, c + i), hn::LoadU(d, b + i)), d, a + i);
}
} // namespace ligament::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ligament::bench
{
HWY_EXPORT(multiply_add);
HWY_EXPORT(lanes);
HWY_EXPORT(triad);

Roofline measure_roofline()
{
  constexpr long steps = 100000, size = 1 << 23;
  volatile double sink = 0;
  const double per_step = 12. * 2 * double(HWY_DYNAMIC_DISPATCH(lanes)());
  const double flops =
      per_step * steps * rate([&] { sink = HWY_DYNAMIC_DISPATCH(multiply_add)(steps); });
  std::vector<double> a(size), b(size, 1.), c(size, 2.);
  const double bytes = 3. * sizeof(double) * size * rate([&] {
                         HWY_DYNAMIC_DISPATCH(triad)(a.data(), b.data(), c.data(), size);
                       });
  return {flops, bytes};
}
} // namespace ligament::bench
#endif
