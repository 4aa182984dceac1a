// What builds with sanitizers cost in time.
#pragma once

namespace ligament::tests
{
/// How much longer than a release build this one may take.
#ifdef LIGAMENT_SANITIZE
inline constexpr double slowness = 20;
#else
inline constexpr double slowness = 1;
#endif
} // namespace ligament::tests
