// Compiled once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "particles/instruction_set.cc"
#include "particles/instruction_set.h"
#include "core/dispatch.h"

#include <hwy/foreach_target.h>
// After foreach_target.h, as Highway wants it.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace ligament::particles::HWY_NAMESPACE
{
const char *name_of_target()
{
  return HWY_TARGET == HWY_EMU128 ? "SSE2" : hwy::TargetName(HWY_TARGET);
}
} // namespace ligament::particles::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ligament::particles
{
HWY_EXPORT(name_of_target);

std::string instruction_set()
{
  return HWY_DYNAMIC_DISPATCH(name_of_target)();
}
} // namespace ligament::particles
#endif
