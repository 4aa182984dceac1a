#include "tests/fuzz/fuzz_cases.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>

#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#ifdef LIGAMENT_SANITIZE
#include <sanitizer/common_interface_defs.h>
#endif

namespace ligament::fuzz
{
namespace
{
constexpr int most_seconds = 20; // of processor time, for one case

std::string document; // that is read now
char sentence[256];   // how to repeat the case; ready before a signal comes

// The address sanitizer tells the others itself.
#ifdef LIGAMENT_SANITIZE
constexpr std::array<int, 1> signals = {SIGPROF};
#else
constexpr std::array<int, 6> signals = {SIGPROF, SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL};
#endif

/// The document may hold anything; the stream takes it as it is. All calls are safe in a handler.
void tell(const char *what)
{
  (void)!write(STDERR_FILENO, what, std::strlen(what));
  (void)!write(STDERR_FILENO, sentence, std::strlen(sentence));
  (void)!write(STDERR_FILENO, document.data(), document.size());
  (void)!write(STDERR_FILENO, "\n", 1);
}

void tell_and_end(int signal)
{
  tell(signal == SIGPROF ? "\nthis case takes too long: " : "\nthis case crashes: ");
  std::signal(signal == SIGPROF ? SIGABRT : signal, SIG_DFL);
  raise(signal == SIGPROF ? SIGABRT : signal);
}

/// For as long as it lives, a case can't take all of the memory or time, nor crash silently.
class Guard
{
public:
  Guard()
  {
    for (const int signal : signals)
      std::signal(signal, tell_and_end);
#ifdef LIGAMENT_SANITIZE
    __sanitizer_set_death_callback([] { tell("\nthis case crashes: "); });
#endif
#ifndef LIGAMENT_SANITIZE // it reserves terabytes
    rlimit memory;
    getrlimit(RLIMIT_AS, &memory);
    before_ = memory;
    memory.rlim_cur = std::min<rlim_t>(memory.rlim_max, 3ul << 30);
    setrlimit(RLIMIT_AS, &memory);
#endif
  }
  ~Guard()
  {
    set_time(0);
#ifndef LIGAMENT_SANITIZE
    setrlimit(RLIMIT_AS, &before_);
#endif
    for (const int signal : signals)
      std::signal(signal, SIG_DFL);
#ifdef LIGAMENT_SANITIZE
    __sanitizer_set_death_callback([] {});
#endif
  }
  void set_time(int seconds)
  {
    itimerval time{};
    time.it_value.tv_sec = seconds;
    setitimer(ITIMER_PROF, &time, nullptr);
  }

private:
  rlimit before_{};
};

/// Seeds of neighbouring cases have nothing in common (splitmix64).
std::uint64_t mixed(std::uint64_t x)
{
  x += 0x9E3779B97F4A7C15;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EB;
  return x ^ (x >> 31);
}

/// False when it failed.
bool run_one(std::uint64_t seed, Guard &guard, const std::function<void(Draw &)> &one_case)
{
  const auto *test = testing::UnitTest::GetInstance()->current_test_info();
  std::snprintf(sentence, sizeof(sentence),
                "repeat it with LIGAMENT_FUZZ_SEED=%llu test_fuzz --gtest_filter=%s.%s\n",
                static_cast<unsigned long long>(seed), test->test_suite_name(), test->name());
  document.clear();
  guard.set_time(most_seconds);
  Draw draw(seed);
  try {
    one_case(draw);
  } catch (const std::exception &error) {
    ADD_FAILURE() << "an exception of a wrong type: " << error.what();
  } catch (...) {
    ADD_FAILURE() << "an exception of a wrong type";
  }
  guard.set_time(0);
  if (testing::Test::HasFailure())
    ADD_FAILURE() << sentence << "the document:\n" << document;
  return !testing::Test::HasFailure();
}

/// The one seed that is asked for, if any is.
bool was_repeated(Guard &guard, const std::function<void(Draw &)> &one_case)
{
  const char *seed = std::getenv("LIGAMENT_FUZZ_SEED");
  if (seed)
    run_one(std::strtoull(seed, nullptr, 10), guard, one_case);
  return seed;
}
} // namespace

void run_cases(std::uint64_t first_seed, int n, const std::function<void(Draw &)> &one_case)
{
  Guard guard;
  if (was_repeated(guard, one_case))
    return;
  for (int k = 0; k < n; ++k)
    if (!run_one(mixed(first_seed + k), guard, one_case))
      return;
}

void run_cases_for(double seconds, const std::function<void(Draw &)> &one_case)
{
  Guard guard;
  if (was_repeated(guard, one_case))
    return;
  if (const char *wanted = std::getenv("LIGAMENT_FUZZ_SECONDS"))
    seconds = std::strtod(wanted, nullptr);
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  const std::uint64_t first_seed = mixed(std::uint64_t(std::time(nullptr)));
  std::uint64_t k = 0;
  for (; Clock::now() < end; ++k)
    if (!run_one(mixed(first_seed + k), guard, one_case))
      break;
  std::printf("%llu cases\n", static_cast<unsigned long long>(k));
}

void note_document(const std::string &text)
{
  document = text;
}

File::File(std::string name, const std::string &text) : name_(std::move(name))
{
  std::ofstream(name_, std::ios::binary) << text;
}

File::~File()
{
  std::remove(name_.c_str());
}
} // namespace ligament::fuzz
