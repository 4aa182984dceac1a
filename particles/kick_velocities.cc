// Compiled once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "particles/kick_velocities.cc"
#include "particles/kick_velocities.h"
#include "core/dispatch.h"

#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway wants it.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace ligament::particles::HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

template <typename D>
HWY_INLINE void kick(D d, double *v, const double *f, const double *m, double dt)
{
  const auto impulse = hn::Mul(hn::Set(d, dt), hn::LoadU(d, f));
  hn::StoreU(hn::Add(hn::LoadU(d, v), hn::Div(impulse, hn::LoadU(d, m))), d, v);
}

void kick_all(double *velocity, const double *force, const double *mass, double dt, int n)
{
  const hn::ScalableTag<double> d;
  const int lanes = int(hn::Lanes(d));
  int i = 0;
  for (; i + lanes <= n; i += lanes)
    kick(d, velocity + i, force + i, mass + i, dt);
  for (; i < n; ++i)
    kick(hn::CappedTag<double, 1>(), velocity + i, force + i, mass + i, dt);
}
} // namespace ligament::particles::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ligament::particles
{
HWY_EXPORT(kick_all);

void kick_velocities(double *velocity, const double *force, const double *mass, double dt, int n)
{
  HWY_DYNAMIC_DISPATCH(kick_all)(velocity, force, mass, dt, n);
}
} // namespace ligament::particles
#endif
