// Every pair of settings stands in the covering set.
#include "src/verification/covering_set.h"

#include <gtest/gtest.h>

namespace ligament::program
{
namespace
{
TEST(CoveringSet, HoldsEveryPairOnceAtLeast)
{
  const std::vector<int> levels = {6, 5, 3, 3, 3, 3, 2};
  const auto rows = covering_set(levels);
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
  EXPECT_EQ(rows, covering_set(levels));
}
} // namespace
} // namespace ligament::program
