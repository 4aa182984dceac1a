// How particles are shared anew: by the times of the ranks, and never by little.
#include "core/ranks_state.h"
#include "particles/block_sum.h"
#include "particles/partition.h"
#include "src/simulation/rank_balance.h"
#include "tests/support/ranks.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ligament::program
{
namespace
{
using particles::make_partition;
using particles::sum_block;
using test::ranks;

TEST(RankBalance, BlocksWeighWhatTheirRankNeeds)
{
  // The second rank needs three times as long for a particle: it should have a quarter of them.
  const std::int64_t n = 800 * sum_block;
  const auto weights = block_weights({n / 2, n / 2}, {1, 3});
  ASSERT_EQ(weights.size(), 800u);
  const auto cuts = make_partition(n, 2, weights).cuts;
  // 400 + 3 x blocks behind: 1600 in all, half of it behind 400 + 400/3 of them.
  EXPECT_EQ(cuts[1] / sum_block, 400 + 133);
}

TEST(RankBalance, TheLastBlockMayBeShort)
{
  const auto weights = block_weights({3 * sum_block, sum_block + 1}, {2, 1});
  EXPECT_EQ(weights, (std::vector<std::int64_t>{200, 200, 200, 100, 100}));
}

TEST(RankBalance, CountsWhatHasAnotherRank)
{
  EXPECT_EQ(n_moved({10, 10, 10}, {10, 10, 10}), 0);
  EXPECT_EQ(n_moved({10, 10, 10}, {12, 8, 10}), 2);
  EXPECT_EQ(n_moved({10, 10, 10}, {12, 10, 8}), 4);
  EXPECT_EQ(n_moved({30, 0, 0}, {0, 0, 30}), 30);
}

TEST(RankBalance, ShiftedWeightsMoveParticles)
{
  if (ranks().is_one())
    return;
  RankBalance balance(ranks());
  const std::int64_t n = 60 * sum_block;
  auto cuts = make_partition(n, ranks().size()).cuts;
  for (int turn = 0; turn < 4; ++turn) {
    const std::int64_t own = cuts[ranks().rank() + 1] - cuts[ranks().rank()];
    const auto next = make_partition(n, ranks().size(), balance.shifted(own)).cuts;
    EXPECT_NE(next, cuts);
    cuts = next;
  }
}

TEST(RankBalance, NothingIsFoundWhereNothingWasMeasured)
{
  RankBalance balance(ranks());
  EXPECT_FALSE(balance.look(100, 50, 1000, 0));
}

TEST(RankBalance, StatesComeFromTheFirstRank)
{
  core::State one;
  core::Table table({3, 5, 8}, 1);
  table.add("number", std::vector<double>{-0., 1e-310, std::nan("7")});
  table.add("count", std::vector<std::int64_t>{-1, 2, 1ll << 62});
  one["particles"] = std::move(table);
  one["none"] = core::Table({}, 2);
  core::save_value(one, "run", "time", 0.1);
  const std::map<std::string, core::State> states = {{"body", one}, {"a name with blanks", {}}};
  const auto found =
      core::from_first(ranks().is_first() ? states : std::map<std::string, core::State>(), ranks());
  EXPECT_EQ(found.size(), states.size());
  for (const auto &[name, state] : states)
    EXPECT_TRUE(found.count(name) && found.at(name) == state) << name;
}
} // namespace
} // namespace ligament::program
