// When a run writes its checkpoints, and what it does when the disk refuses.
#pragma once

#include "core/check.h"
#include "core/log.h"
#include "src/output/checkpoints.h"

#include <chrono>

namespace ligament::program
{
class CheckpointKeeper
{
public:
  /// `interval` in s of wall time; infinite: none is ever due. `has_some`: the run goes on from
  /// one.
  CheckpointKeeper(Checkpoints checkpoints, double interval, bool has_some);

  bool is_due() const { return Clock::now() >= next_; }
  /// The run has lasted long enough for one.
  bool has_some() const { return has_some_; }

  /// write(checkpoints) may throw core::EnvironmentError. That is a warning, and tried again after
  /// a minute at most; the third time in a row it is thrown on.
  template <typename Write>
  void attempt(core::Log &log, Write &&write);

private:
  using Clock = std::chrono::steady_clock;
  static constexpr int most_failures = 3;
  static constexpr double longest_pause = 60; // s

  void wait(double seconds);

  Checkpoints checkpoints_;
  double interval_;
  bool has_some_;
  Clock::time_point next_;
  int failures_ = 0; // in a row
};

template <typename Write>
void CheckpointKeeper::attempt(core::Log &log, Write &&write)
{
  try {
    write(checkpoints_);
    failures_ = 0;
    has_some_ = true;
    wait(interval_);
  } catch (const core::EnvironmentError &error) {
    if (++failures_ == most_failures)
      throw core::EnvironmentError(
          fmt::format("{} checkpoints in a row could not be written: {}", failures_, error.what()));
    log.warning("a checkpoint could not be written: {}", error.what());
    wait(std::min(interval_, longest_pause));
  }
}
} // namespace ligament::program
