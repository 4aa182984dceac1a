#include "src/simulation/checkpoint_keeper.h"

#include <cmath>

namespace ligament::program
{
CheckpointKeeper::CheckpointKeeper(Checkpoints checkpoints, double interval, bool has_some)
    : checkpoints_(std::move(checkpoints)), interval_(interval), has_some_(has_some)
{
  wait(interval_);
}

void CheckpointKeeper::wait(double seconds)
{
  const std::chrono::duration<double> longest = std::chrono::hours(24 * 365 * 100);
  next_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                             std::min(std::chrono::duration<double>(seconds), longest));
}
} // namespace ligament::program
