// Section timers: exclusive times that add up to the total.
#include "core/timers.h"

#include <gtest/gtest.h>

#include <thread>

using ligament::core::Timers;

namespace
{
constexpr std::chrono::milliseconds nap(20);
const double nap_seconds = std::chrono::duration<double>(nap).count();

TEST(Timers, GoOnWithWhatPassedBefore)
{
  Timers timers;
  timers.section("forces");
  timers.add({{"forces", 2, 7}, {"output", 1, 3}, {"rest", 4, 0}});
  const auto rows = timers.rows();
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].name, "forces");
  EXPECT_EQ(rows[0].seconds, 2);
  EXPECT_EQ(rows[0].calls, 7);
  EXPECT_EQ(rows[1].seconds, 1);
  EXPECT_GE(rows[2].seconds, 4);
  EXPECT_NEAR(timers.total(), 7, 1);
}

TEST(Timers, InnerSectionsAreNotCountedTwice)
{
  Timers timers;
  const int outer = timers.section("outer"), inner = timers.section("inner");
  EXPECT_EQ(timers.section("outer"), outer);
  {
    const auto a = timers.scope(outer);
    std::this_thread::sleep_for(nap);
    {
      const auto b = timers.scope(inner);
      std::this_thread::sleep_for(2 * nap);
    }
    std::this_thread::sleep_for(nap);
  }
  const auto rows = timers.rows();
  const double total = timers.total();
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].calls, 1);
  EXPECT_EQ(rows[1].calls, 1);
  EXPECT_EQ(rows[2].name, "rest");
  // A sleep is never shorter than asked for; the sum bounds what each may be longer.
  EXPECT_GE(rows[0].seconds, 2 * nap_seconds);
  EXPECT_GE(rows[1].seconds, 2 * nap_seconds);
  EXPECT_LE(rows[0].seconds, total - 2 * nap_seconds);
  const double sum = rows[0].seconds + rows[1].seconds + rows[2].seconds;
  // total() was read after rows(): the difference is the time between the two clock reads.
  EXPECT_LE(sum, total);
  EXPECT_NEAR(sum, total, 0.5 * nap_seconds);
}

TEST(Timers, RunningSectionCountsUpToNow)
{
  Timers timers;
  const auto scope = timers.scope(timers.section("forces"));
  std::this_thread::sleep_for(nap);
  EXPECT_GE(timers.rows()[0].seconds, nap_seconds);
}

TEST(Timers, TableShowsSharesAndTimePerCall)
{
  const std::string text = ligament::core::timing_table({{"forces", 3, 1000000}, {"rest", 1, 0}});
  EXPECT_NE(text.find("75.0 %"), std::string::npos) << text; // 3/(3 + 1)
  EXPECT_NE(text.find("3.00"), std::string::npos) << text;   // us per call
  EXPECT_NE(text.find("4.000"), std::string::npos) << text;  // total
}
} // namespace
