// Compiled once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "md/neighbour_search.cc"
#include "md/neighbour_search.h"
#include "core/dispatch.h"

#include <cstdint>

#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway wants it.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace ligament::md::HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

int find(const PlaceArrays &p, int begin, int end, float x, float y, float z, float reach2,
         int *found)
{
  const hn::ScalableTag<float> d;
  const int lanes = int(hn::Lanes(d));
  const auto xs = hn::Set(d, x), ys = hn::Set(d, y), zs = hn::Set(d, z), limit = hn::Set(d, reach2);
  int n = 0;
  for (int k = begin; k < end; k += lanes) { // arrays are padded by a vector
    const auto dx = hn::Sub(hn::LoadU(d, p.x + k), xs), dy = hn::Sub(hn::LoadU(d, p.y + k), ys),
               dz = hn::Sub(hn::LoadU(d, p.z + k), zs);
    const auto r2 = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
    auto near = hn::Lt(r2, limit);
    if (k + lanes > end)
      near = hn::And(near, hn::FirstN(d, std::size_t(end - k)));
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, near, bytes);
    for (unsigned bits = bytes[0] | unsigned(bytes[1]) << 8; bits; bits &= bits - 1)
      found[n++] = k + __builtin_ctz(bits);
  }
  return n;
}

FindNear choose_search()
{
  return &find;
}
} // namespace ligament::md::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ligament::md
{
HWY_EXPORT(choose_search);

FindNear find_near()
{
  return HWY_DYNAMIC_DISPATCH(choose_search)();
}
} // namespace ligament::md
#endif
