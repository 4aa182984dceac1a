// The front of a cost-error diagram: by its definition, point against point.
#include "src/sweep/pareto.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace ligament::program;

namespace
{
using Indices = std::vector<std::size_t>;

TEST(Pareto, KeepsWhatNothingBeats)
{
  //  1 is slower and worse than 0; 3 ties with 2 in error and is slower; 4 repeats 2.
  EXPECT_EQ(pareto_front({1, 2, 3, 4, 3, 5}, {9, 10, 4, 4, 4, 1}), (Indices{0, 2, 5}));
  EXPECT_EQ(pareto_front({5, 1}, {1, 5}), (Indices{1, 0})); // by rising cost
  EXPECT_EQ(pareto_front({}, {}), Indices());
}

TEST(Pareto, PointsWithoutValueTakeNoPart)
{
  EXPECT_EQ(pareto_front({1, NAN, 3}, {NAN, 0, 2}), Indices{2});
  EXPECT_EQ(pareto_front({INFINITY}, {0}), Indices());
}

TEST(Pareto, AgreesWithTheDefinition)
{
  std::mt19937 random(3);
  std::uniform_int_distribution<int> coarse(0, 9); // many ties
  std::vector<double> cost, error;
  for (int i = 0; i < 200; ++i) {
    cost.push_back(coarse(random));
    error.push_back(coarse(random));
  }
  const auto beats = [&](std::size_t a, std::size_t b) {
    return cost[a] <= cost[b] && error[a] <= error[b] &&
           (cost[a] < cost[b] || error[a] < error[b] || a < b);
  };
  Indices expected;
  for (std::size_t i = 0; i < cost.size(); ++i) {
    bool beaten = false;
    for (std::size_t j = 0; j < cost.size(); ++j)
      beaten = beaten || (j != i && beats(j, i));
    if (!beaten)
      expected.push_back(i);
  }
  Indices front = pareto_front(cost, error);
  std::sort(front.begin(), front.end());
  EXPECT_EQ(front, expected);
}
} // namespace
