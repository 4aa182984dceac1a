// A body counts as broken when nothing joins two opposite sides any more, neither bonds nor cells.
#include "src/simulation/connectivity.h"
#include "tests/support/small_plate.h"

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
std::vector<std::string> cut(double from, double to)
{
  return {fmt::format("/specimen/cracks=[{{\"points\": [[{}, 0], [{}, 0]]}}]", from, to)};
}

TEST(Connectivity, ACutFromSideToSideBreaksTheBody)
{
  for (const auto &far : {"/coupling/overlap_cells=2", "/far_field=none"}) {
    SCOPED_TRACE(far);
    const SmallBody small(small_scene(cut(-12, 12) + std::vector<std::string>{far}));
    EXPECT_TRUE(is_broken_across(small.body, 1));
    // The halves still reach from left to right.
    EXPECT_FALSE(is_broken_across(small.body, 0));
  }
}

TEST(Connectivity, ALigamentOfThreeParticlesHoldsTheBody)
{
  for (const auto &far : {"/coupling/overlap_cells=2", "/far_field=none"}) {
    SCOPED_TRACE(far);
    const SmallBody small(small_scene(cut(-12, 9) + std::vector<std::string>{far}));
    EXPECT_FALSE(is_broken_across(small.body, 1));
  }
}

TEST(Connectivity, AMeshHoldsTogether)
{
  const SmallBody small(
      small_scene({"/discrete_zone=none", "/far_field/levels=1", "/far_field/cells_per_level=2"}));
  EXPECT_FALSE(is_broken_across(small.body, 0));
  EXPECT_FALSE(is_broken_across(small.body, 1));
}
} // namespace
