// What ranks tell each other arrives, and sums over them have no order.
#include "tests/support/ranks.h"

#include "core/check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

namespace ligament::core::testing
{
namespace
{
using test::ranks;

std::uint64_t bits(double value)
{
  std::uint64_t b;
  std::memcpy(&b, &value, sizeof(b));
  return b;
}

TEST(Ranks, OneProcessIsByItself)
{
  const Ranks one;
  EXPECT_TRUE(one.is_one());
  EXPECT_EQ(one.size(), 1);
  EXPECT_EQ(one.rank(), 0);
  EXPECT_EQ(one.gather(std::vector<int>{3, 4}), (std::vector<std::vector<int>>{{3, 4}}));
  EXPECT_EQ(one.deal(std::vector<std::vector<int>>{{5}}), (std::vector<std::vector<int>>{{5}}));
  EXPECT_EQ(one.max(std::int64_t(-7)), -7);
  EXPECT_NO_THROW(one.agree_on("nothing", 1));
  EXPECT_THROW(one.abort("alone", 1), InputError);
}

TEST(Ranks, GatherKeepsTheOrderOfTheRanks)
{
  // Rank r gives r numbers: one of them gives nothing.
  const int r = ranks().rank(), n = ranks().size();
  std::vector<std::int64_t> mine;
  for (int k = 0; k < r; ++k)
    mine.push_back(100 * r + k);
  const auto all = ranks().gather(mine);
  ASSERT_EQ(int(all.size()), n);
  for (int k = 0; k < n; ++k) {
    ASSERT_EQ(int(all[k].size()), k);
    for (int m = 0; m < k; ++m)
      EXPECT_EQ(all[k][m], 100 * k + m);
  }
}

TEST(Ranks, DealSendsEachItsOwn)
{
  const int r = ranks().rank(), n = ranks().size();
  std::vector<std::vector<int>> to(n);
  for (int k = 0; k < n; ++k)
    to[k].assign(k + 1, 10 * r + k);
  const auto come = ranks().deal(to);
  ASSERT_EQ(int(come.size()), n);
  for (int k = 0; k < n; ++k)
    EXPECT_EQ(come[k], std::vector<int>(r + 1, 10 * k + r));
}

TEST(Ranks, MessagesReachTheirRanks)
{
  const int r = ranks().rank(), n = ranks().size();
  std::vector<std::vector<double>> out(n), in(n);
  std::vector<Communicator::Outgoing> outgoing;
  std::vector<Communicator::Incoming> incoming;
  for (int k = 0; k < n; ++k)
    if (k != r) {
      out[k].assign(1 + 1000 * r, 10 * r + k); // from small to what no eager buffer takes
      in[k].assign(1 + 1000 * k, -1);
      outgoing.push_back({k, out[k].data(), out[k].size() * sizeof(double)});
      incoming.push_back({k, in[k].data(), in[k].size() * sizeof(double)});
    }
  ranks().exchange(outgoing, incoming);
  for (int k = 0; k < n; ++k)
    if (k != r) {
      EXPECT_EQ(in[k], std::vector<double>(1 + 1000 * k, 10 * k + r));
    }
}

// MPI counts in ints: what is longer comes in pieces.
TEST(Ranks, LongMessagesArriveInPieces)
{
  const int n = ranks().size();
  for (const std::size_t longest : {1, 7, 64}) {
    const Ranks in_pieces = test::ranks_in_pieces(longest);
    const int r = in_pieces.rank();
    const auto told = [](int from, int to) {
      std::vector<std::int16_t> values(5 * from + 3 * to);
      for (std::size_t k = 0; k < values.size(); ++k)
        values[k] = std::int16_t(1000 * from + 100 * to + int(k));
      return values;
    };
    std::vector<std::vector<std::int16_t>> to(n);
    for (int k = 0; k < n; ++k)
      to[k] = told(r, k);
    const auto come = in_pieces.deal(to), all = in_pieces.gather(told(r, r));
    const auto at_first = in_pieces.gather_at_first(told(r, r));
    std::vector<std::int16_t> joined;
    for (int k = 0; k < n; ++k) {
      EXPECT_EQ(come[k], told(k, r));
      EXPECT_EQ(all[k], told(k, k));
      joined.insert(joined.end(), all[k].begin(), all[k].end());
    }
    EXPECT_EQ(at_first, r == 0 ? joined : std::vector<std::int16_t>());
  }
  if (n > 1) {
    EXPECT_THROW(test::ranks_in_pieces(0), InputError);
  }
}

TEST(Ranks, SumsAreThoseOfAllTerms)
{
  // Terms over 600 orders of magnitude, dealt out in turn: plain sums of parts would differ.
  const int r = ranks().rank(), n = ranks().size();
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> exponent(-300, 300), sign(-1, 1);
  ExactSum all, mine;
  for (int k = 0; k < 5000; ++k) {
    const double term = std::copysign(std::pow(10., exponent(random)), sign(random));
    all.add(term);
    if (k % n == r)
      mine.add(term);
  }
  EXPECT_EQ(bits(ranks().sum(mine).value()), bits(all.value()));
  const auto two = ranks().sum(std::vector<ExactSum>{mine, ExactSum()});
  EXPECT_EQ(bits(two[0].value()), bits(all.value()));
  EXPECT_EQ(bits(two[1].value()), bits(0.));
}

TEST(Ranks, SumsOfWhatIsNoNumber)
{
  // Every rank has a +infinity: still one; with a -infinity or a NaN of the last rank NaN.
  const double infinity = std::numeric_limits<double>::infinity();
  ExactSum plus, both, none;
  plus.add(infinity);
  both.add(infinity);
  if (ranks().rank() == ranks().size() - 1) {
    both.add(-infinity);
    none.add(std::nan(""));
  }
  EXPECT_EQ(ranks().sum(plus).value(), infinity);
  EXPECT_TRUE(std::isnan(ranks().sum(both).value()));
  EXPECT_TRUE(std::isnan(ranks().sum(none).value()));
}

TEST(Ranks, LargestAndAny)
{
  const std::int64_t r = ranks().rank(), n = ranks().size();
  EXPECT_EQ(ranks().max(-r), 0);
  EXPECT_EQ(ranks().max(std::vector<std::int64_t>{r, -r, 7}),
            (std::vector<std::int64_t>{n - 1, 0, 7}));
  EXPECT_EQ(ranks().sum(r), n * (n - 1) / 2);
  EXPECT_TRUE(ranks().any(r == n - 1));
  EXPECT_FALSE(ranks().any(false));
}

TEST(Ranks, WhatIsNotTheSameIsToldEverywhere)
{
  EXPECT_NO_THROW(ranks().agree_on("the step", 0.1));
  const bool odd = ranks().rank() == ranks().size() - 1;
  if (!ranks().is_one()) {
    EXPECT_THROW(ranks().agree_on("the step", odd ? std::nextafter(0.1, 1) : 0.1), InputError);
    EXPECT_THROW(ranks().agree_on("a zero", odd ? -0. : 0.), InputError);
  }
}
} // namespace
} // namespace ligament::core::testing
