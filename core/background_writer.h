// Files written beside the computation, one after the other, on a thread of their own.
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace ligament::core
{
/// A job owns copies of what it writes: the caller goes on changing its data. At most one job waits
/// behind the one at work, which bounds the memory of the copies.
class BackgroundWriter
{
public:
  BackgroundWriter();
  /// Finishes all jobs; an error that nobody waited for is lost.
  ~BackgroundWriter();
  BackgroundWriter(const BackgroundWriter &) = delete;
  BackgroundWriter &operator=(const BackgroundWriter &) = delete;

  /// Hands over a job; waits while another one is waiting already. Throws what an earlier job
  /// threw.
  void submit(std::function<void()> job);

  /// Returns when nothing is left to do; throws what a job threw.
  void wait();

private:
  void work();
  void rethrow();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::function<void()> next_; // empty: none waits
  bool busy_ = false, closing_ = false;
  std::exception_ptr error_;
  std::thread thread_; // last: starts when all else stands
};
} // namespace ligament::core
