// How particles are shared by ranks while a run goes on: by the times that their work took.
#pragma once

#include "core/ranks.h"

#include <chrono>
#include <optional>
#include <vector>

namespace ligament::program
{
/// Results don't depend on where a body is cut: weights may be measured times. All ranks make the
/// same calls; one process never finds anything.
class RankBalance
{
public:
  explicit RankBalance(core::Ranks ranks) : ranks_(std::move(ranks)) {}

  /// Between the two the rank steps its particles, and waits for others.
  void begin();
  void end();

  /// Weights of the blocks of particles by which the body should be cut from now on, as
  /// particles::make_partition() takes them; nothing where that doesn't pay: what waiting for the
  /// slowest rank would cost in `steps_left` steps must be twice the `cost` of building the body
  /// anew, in s. `n_own`: particles that the rank owns.
  std::optional<std::vector<std::int64_t>> look(std::int64_t n_own, long step, long steps_left,
                                                double cost);

  /// Weights that move particles in any case, each time others: for tests.
  std::vector<std::int64_t> shifted(std::int64_t n_own);

  /// Share of the work's time that the slowest rank takes longer than the mean, when look() last
  /// had a time to look at.
  double imbalance() const { return imbalance_; }

private:
  using Clock = std::chrono::steady_clock;

  core::Ranks ranks_;
  Clock::time_point begun_;
  double waited_before_ = 0;      // s
  double seconds_ = 0, work_ = 0; // since the last look: all of it, without waiting
  long step_ = 0, n_shifted_ = 0; // of the last look
  double imbalance_ = 0;
};

/// Particles that have another rank than before, by the numbers that each one has of those in the
/// one order.
std::int64_t n_moved(const std::vector<std::int64_t> &before,
                     const std::vector<std::int64_t> &after);

/// Weights of blocks of which rank r's particles (n_own[r] of them) weigh weight[r] each.
std::vector<std::int64_t> block_weights(const std::vector<std::int64_t> &n_own,
                                        const std::vector<double> &weight);
} // namespace ligament::program
