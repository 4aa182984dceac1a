#include "core/background_writer.h"

#include <utility>

namespace ligament::core
{
BackgroundWriter::BackgroundWriter() : thread_([this] { work(); })
{
}

BackgroundWriter::~BackgroundWriter()
{
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void BackgroundWriter::submit(std::function<void()> job)
{
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !next_; });
    rethrow();
    next_ = std::move(job);
  }
  changed_.notify_all();
}

void BackgroundWriter::wait()
{
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !next_ && !busy_; });
  rethrow();
}

void BackgroundWriter::rethrow()
{
  if (error_)
    std::rethrow_exception(std::exchange(error_, nullptr));
}

void BackgroundWriter::work()
{
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return next_ || closing_; });
    if (!next_)
      return;
    auto job = std::exchange(next_, nullptr);
    busy_ = true;
    lock.unlock();
    changed_.notify_all();
    std::exception_ptr error;
    try {
      job();
    } catch (...) {
      error = std::current_exception();
    }
    job = nullptr; // its data go before the next one's come
    lock.lock();
    busy_ = false;
    if (error && !error_)
      error_ = error;
    changed_.notify_all();
  }
}
} // namespace ligament::core
