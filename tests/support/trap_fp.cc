// With LIGAMENT_TRAP_FP set, a test program ends by SIGFPE where a number is made that is none: by a
// division by zero or an invalid operation. Overflows are none: readers look for them afterwards.
// Meant for the build of scripts/sanitize.sh: the release flags let the compiler compute what is
// then not used.
#include <cfenv>
#include <cstdlib>

namespace
{
__attribute__((constructor)) void trap_floating_point()
{
#ifdef __GLIBC__
  if (std::getenv("LIGAMENT_TRAP_FP"))
    feenableexcept(FE_DIVBYZERO | FE_INVALID);
#endif
}
} // namespace
