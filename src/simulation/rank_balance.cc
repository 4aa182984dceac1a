#include "src/simulation/rank_balance.h"

#include "particles/block_sum.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ligament::program
{
namespace
{
// Times of fewer seconds say little.
constexpr double least_seconds = 5;
// A core that is slower now and then is no reason: of the mean.
constexpr double least_imbalance = 0.05;
// What is saved must be worth the cost of building anew so many times.
constexpr double worth = 2;
// Of the lightest particles, so that ratios of weights are not cut off.
constexpr double unit = 100;
} // namespace

std::vector<std::int64_t> block_weights(const std::vector<std::int64_t> &n_own,
                                        const std::vector<double> &weight)
{
  const double least = *std::min_element(weight.begin(), weight.end());
  std::vector<std::int64_t> weights;
  std::int64_t end = 0; // of the rank's particles in the order; cuts lie between blocks
  for (std::size_t r = 0; r < n_own.size(); ++r) {
    end += n_own[r];
    const std::int64_t n_blocks = (end + particles::sum_block - 1) / particles::sum_block;
    weights.resize(std::size_t(n_blocks), std::llround(unit * weight[r] / least));
  }
  return weights;
}

std::int64_t n_moved(const std::vector<std::int64_t> &before,
                     const std::vector<std::int64_t> &after)
{
  std::int64_t stay = 0, n = 0, begin_before = 0, begin_after = 0;
  for (std::size_t r = 0; r < before.size(); ++r) {
    const std::int64_t end_before = begin_before + before[r], end_after = begin_after + after[r];
    stay += std::max<std::int64_t>(0, std::min(end_before, end_after) -
                                          std::max(begin_before, begin_after));
    n += after[r];
    begin_before = end_before;
    begin_after = end_after;
  }
  return n - stay;
}

void RankBalance::begin()
{
  if (ranks_.is_one())
    return;
  begun_ = Clock::now();
  waited_before_ = ranks_.waited();
}

void RankBalance::end()
{
  if (ranks_.is_one())
    return;
  const double seconds = std::chrono::duration<double>(Clock::now() - begun_).count();
  seconds_ += seconds;
  work_ += seconds - (ranks_.waited() - waited_before_);
}

std::optional<std::vector<std::int64_t>> RankBalance::look(std::int64_t n_own, long step,
                                                           long steps_left, double cost)
{
  // Clocks differ: the first rank's decides.
  if (!ranks_.any(ranks_.is_first() && seconds_ >= least_seconds))
    return {};
  const auto work = ranks_.gather_all(std::vector<double>{work_});
  const auto n = ranks_.gather_all(std::vector<std::int64_t>{n_own});
  const double most = *std::max_element(work.begin(), work.end()),
               mean = std::accumulate(work.begin(), work.end(), 0.) / double(work.size());
  const double saving = (most - mean) / double(std::max(step - step_, 1L)) * double(steps_left);
  const double largest_cost = ranks_.gather_all(std::vector<double>{cost})[0];
  step_ = step;
  seconds_ = work_ = 0;
  imbalance_ = most / mean - 1;
  const bool has_all =
      *std::min_element(n.begin(), n.end()) > 0 && *std::min_element(work.begin(), work.end()) > 0;
  if (!has_all || imbalance_ < least_imbalance || saving < worth * largest_cost)
    return {};
  std::vector<double> weight;
  for (std::size_t r = 0; r < work.size(); ++r)
    weight.push_back(work[r] / double(n[r]));
  return block_weights(n, weight);
}

std::vector<std::int64_t> RankBalance::shifted(std::int64_t n_own)
{
  const auto n = ranks_.gather_all(std::vector<std::int64_t>{n_own});
  ++n_shifted_;
  std::vector<double> weight;
  for (std::size_t r = 0; r < n.size(); ++r)
    weight.push_back((r + n_shifted_) % 2 ? 3 : 2);
  return block_weights(n, weight);
}
} // namespace ligament::program
