// Signals that ask a program to end (SIGINT, SIGTERM, SIGHUP; SIGUSR1 of mpirun and
// of schedulers), taken where its files can be closed.
#pragma once

#include <atomic>
#include <chrono>
#include <csignal>
#include <functional>
#include <mutex>
#include <thread>

namespace ligament::core
{
/// While it lives, the signals end the process in good order: either `last_words` are said and the
/// process exits with 128 + signal, or, once the caller looks for it, signal() is no longer 0 and
/// the caller ends by itself; a second signal then does not wait for the caller, unless it follows
/// the first one so soon that both are one wish. Signals that are ignored (nohup) stay ignored. To
/// be made before any other thread: they inherit what is blocked.
class Interruption
{
public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption &) = delete;
  Interruption &operator=(const Interruption &) = delete;

  /// From here on signals end the process at once, after these words, said on a thread of its own.
  void end_at_once(std::function<void(int signal)> last_words);
  /// From here on the first signal is left to the caller.
  void leave_to_caller() { left_to_caller_ = true; }
  /// The signal that asks the caller to end; 0: none.
  int signal() const
  {
    const int own = signal_.load(std::memory_order_relaxed);
    return own != 0 ? own : heard_of_.load(std::memory_order_relaxed);
  }
  /// Another process of the same run was asked by this signal: the caller is, too. One that comes
  /// here afterwards is the first one all the same.
  void hear_of(int signal) { heard_of_ = signal; }

  /// For a process whose libraries start threads before it can make one: these inherit what is
  /// blocked now.
  static void block_for_threads();

  /// "SIGINT", ...
  static const char *name(int signal);
  /// GNU `timeout` signals a process and then its group; a terminal and mpirun may both pass one
  /// on.
  static constexpr std::chrono::seconds one_wish{1};

  /// What a shell shows for a program that a signal ended.
  static int exit_code(int signal) { return 128 + signal; }

private:
  void listen();
  void take(int signal);

  std::atomic<int> signal_{0}, heard_of_{0};
  std::atomic<bool> left_to_caller_{false};
  std::chrono::steady_clock::time_point signalled_at_; // of the first that was left to the caller
  std::mutex mutex_;
  std::function<void(int)> last_words_;
  int signals_ = -1, end_ = -1; // descriptors
  sigset_t taken_, before_;
  std::thread listener_; // last: starts when all else stands
};
} // namespace ligament::core
