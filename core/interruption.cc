#include "core/interruption.h"

#include "core/check.h"

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string>

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

namespace ligament::core
{
namespace
{
constexpr int all_signals[] = {SIGINT, SIGTERM, SIGHUP, SIGUSR1};

sigset_t those_not_ignored()
{
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : all_signals) {
    struct sigaction action;
    if (::sigaction(signal, nullptr, &action) == 0 && action.sa_handler != SIG_IGN)
      sigaddset(&set, signal);
  }
  return set;
}
} // namespace

Interruption::Interruption() : taken_(those_not_ignored())
{
  pthread_sigmask(SIG_BLOCK, &taken_, &before_);
  signals_ = ::signalfd(-1, &taken_, SFD_CLOEXEC);
  end_ = ::eventfd(0, EFD_CLOEXEC);
  require<EnvironmentError>(signals_ >= 0 && end_ >= 0,
                            std::string("cannot listen for signals: ") + std::strerror(errno));
  listener_ = std::thread([this] { listen(); });
}

Interruption::~Interruption()
{
  const std::uint64_t one = 1;
  if (::write(end_, &one, sizeof(one)) == sizeof(one))
    listener_.join();
  else
    listener_.detach(); // never: the counter was 0
  ::close(signals_);
  ::close(end_);
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void Interruption::end_at_once(std::function<void(int)> last_words)
{
  const std::lock_guard lock(mutex_);
  last_words_ = std::move(last_words);
  left_to_caller_ = false;
}

void Interruption::listen()
{
  pollfd sources[] = {{signals_, POLLIN, 0}, {end_, POLLIN, 0}};
  while (true) {
    if (::poll(sources, 2, -1) < 0)
      continue; // EINTR
    if (sources[1].revents)
      return;
    signalfd_siginfo info;
    if (::read(signals_, &info, sizeof(info)) == sizeof(info))
      take(int(info.ssi_signo));
  }
}

void Interruption::take(int signal)
{
  const std::lock_guard lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  if (left_to_caller_ && signal_ == 0) {
    signalled_at_ = now;
    signal_ = signal;
    return;
  }
  if (signal_ != 0 && now - signalled_at_ < one_wish)
    return;
  if (last_words_)
    try {
      last_words_(signal);
    } catch (const std::exception &) {
      // Nothing is left to do about it.
    }
  ::_exit(exit_code(signal));
}

void Interruption::block_for_threads()
{
  const sigset_t signals = those_not_ignored();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

const char *Interruption::name(int signal)
{
  return signal == SIGINT    ? "SIGINT"
         : signal == SIGTERM ? "SIGTERM"
         : signal == SIGHUP  ? "SIGHUP"
         : signal == SIGUSR1 ? "SIGUSR1"
                             : "a signal";
}
} // namespace ligament::core
