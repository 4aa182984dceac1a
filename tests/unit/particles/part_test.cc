// Ranges of particles: what two have in common, what they count.
#include "particles/part.h"

#include <gtest/gtest.h>

#include <random>

namespace ligament::particles::testing
{
namespace
{
TEST(Part, IntersectionIsWhatBothHave)
{
  std::mt19937 random(5);
  constexpr int n = 60;
  const auto draw = [&](std::vector<bool> &is_in) {
    ParticleRanges ranges;
    is_in.assign(n, false);
    for (int i = int(random() % 4); i < n;) {
      const int end = std::min(n, i + 1 + int(random() % 7));
      ranges.push_back({i, end});
      for (int k = i; k < end; ++k)
        is_in[k] = true;
      i = end + 1 + int(random() % 5);
    }
    return ranges;
  };
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<bool> a, b;
    const ParticleRanges both = intersection(draw(a), draw(b));
    std::vector<bool> found(n, false);
    int last = -1;
    for_each(both, [&](int i) {
      EXPECT_GT(i, last); // ascending, none twice
      last = i;
      found[i] = true;
    });
    for (int i = 0; i < n; ++i)
      EXPECT_EQ(found[i], a[i] && b[i]);
    EXPECT_EQ(count(both), std::count(found.begin(), found.end(), true));
  }
}

TEST(Part, WholeIsAll)
{
  const Part whole = Part::whole(7);
  EXPECT_TRUE(whole.is_whole(7));
  EXPECT_FALSE(whole.is_whole(8));
  EXPECT_EQ(count(whole.stepped), 7);
}
} // namespace
} // namespace ligament::particles::testing
