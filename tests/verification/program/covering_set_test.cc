// Every pair of settings stands in the covering set.
#include "src/verification/instruments/covering_set.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ligament::program
{
namespace
{
const auto all = [](const std::vector<int> &) { return true; };

TEST(CoveringSet, HoldsEveryPairOnceAtLeast)
{
  const std::vector<int> levels = {6, 5, 3, 3, 3, 3, 2};
  const auto set = covering_set(levels, all);
  const auto &rows = set.rows;
  EXPECT_TRUE(set.given_up.empty());
  for (std::size_t f = 0; f < levels.size(); ++f)
    for (std::size_t g = f + 1; g < levels.size(); ++g)
      for (int a = 0; a < levels[f]; ++a)
        for (int b = 0; b < levels[g]; ++b) {
          bool found = false;
          for (const auto &row : rows)
            found = found || (row[f] == a && row[g] == b);
          EXPECT_TRUE(found) << f << " " << a << ", " << g << " " << b;
        }
  EXPECT_GE(rows.size(), 30u); // pairs of the two largest factors
  EXPECT_LE(rows.size(), 80u);
  EXPECT_EQ(rows, covering_set(levels, all).rows);
}

// Level 2 of factor 2 never stands beside level 1 of factor 3: of all pairs this one alone is given
// up, though rows that hold it are refused with all their pairs.
TEST(CoveringSet, CoversWhatIsAcceptedAndGivesUpTheRest)
{
  const std::vector<int> levels = {6, 5, 3, 3, 2};
  const auto accepts = [](const std::vector<int> &row) { return row[2] != 2 || row[3] != 1; };
  const auto set = covering_set(levels, accepts);
  const std::array<int, 4> refused = {2, 2, 3, 1};
  ASSERT_EQ(set.given_up.size(), 1u);
  EXPECT_EQ(set.given_up[0], refused);
  for (const auto &row : set.rows)
    EXPECT_TRUE(accepts(row));
  int n_pairs = 0;
  for (std::size_t f = 0; f < levels.size(); ++f)
    for (std::size_t g = f + 1; g < levels.size(); ++g)
      for (int a = 0; a < levels[f]; ++a)
        for (int b = 0; b < levels[g]; ++b)
          n_pairs += std::any_of(set.rows.begin(), set.rows.end(),
                                 [&](const auto &row) { return row[f] == a && row[g] == b; });
  EXPECT_EQ(n_pairs, 30 + 18 + 18 + 12 + 15 + 15 + 10 + 9 + 6 + 6 - 1);
}
} // namespace
} // namespace ligament::program
