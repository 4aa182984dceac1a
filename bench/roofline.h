// What the machine can do at most: arithmetic and memory traffic of one core.
#pragma once

#include <ctime>
#include <functional>

namespace ligament::bench
{
/// Seconds of processor time of this thread: other work on the machine doesn't count.
inline double seconds_now()
{
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// Calls per second: the best of several runs of at least a tenth of a second.
inline double rate(const std::function<void()> &call)
{
  double best = 0;
  call();
  for (int run = 0; run < 7; ++run) {
    const double start = seconds_now();
    int calls = 0;
    double seconds = 0;
    while (seconds < 0.1) {
      call();
      ++calls;
      seconds = seconds_now() - start;
    }
    best = best > calls / seconds ? best : calls / seconds;
  }
  return best;
}

struct Roofline
{
  double flops; // per second: independent multiply-adds in the dispatch target's vectors
  double bytes; // per second: triad a = b + s c over 200 MB, three streams counted
};

/// With the instruction set that the run-time dispatch chooses at present.
Roofline measure_roofline();
} // namespace ligament::bench
