// How much memory this process has needed.
#pragma once

#include <sys/resource.h>

namespace ligament::program
{
/// Largest resident set so far, in bytes; libraries included, as the machine has to provide it.
inline double peak_memory()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024. * double(usage.ru_maxrss);
}
} // namespace ligament::program
