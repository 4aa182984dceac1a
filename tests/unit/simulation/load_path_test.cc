// The section that is left between two sides: mesh and bonds, ligaments, bridges and fragments.
#include "src/simulation/load_path.h"
#include "tests/support/small_plate.h"

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
const std::string square = R"(/discrete_zone/packing="square")";

std::vector<std::string> cuts(const std::vector<std::array<double, 3>> &from_to_y)
{
  std::string list;
  for (const auto &[from, to, y] : from_to_y)
    list += fmt::format("{}{{\"points\": [[{}, {}], [{}, {}]]}}", list.empty() ? "" : ", ", from, y,
                        to, y);
  return {"/specimen/cracks=[" + list + "]", square};
}

double section(const SmallBody &small, int axis)
{
  return smallest_section(small.body, axis, Carrying::now);
}

// Square packing of spacing 1: each column of particles is a face of area 1.
TEST(LoadPath, SectionIsTheIntactWidth)
{
  for (const auto &far : {"/coupling/overlap_cells=2", "/far_field=none"}) {
    SCOPED_TRACE(far);
    const auto with = [&](const std::vector<std::array<double, 3>> &list) {
      return SmallBody(small_scene(cuts(list) + std::vector<std::string>{far}));
    };
    EXPECT_NEAR(section(with({{-4, 4, 0}}), 1), 24 - 8, 1e-9);
    EXPECT_NEAR(section(with({{-12, 9, 0}}), 1), 3, 1e-9);
    EXPECT_EQ(section(with({{-12, 12, 0}}), 1), 0);
    // The halves still reach from left to right.
    EXPECT_GT(section(with({{-12, 12, 0}}), 0), 30);
  }
}

// A strip between two cuts that hangs on one half by two bonds, on the other by one.
TEST(LoadPath, AFragmentBetweenTheHalvesIsAsWideAsItsNarrowestBridge)
{
  const SmallBody small(small_scene(cuts({{-12, 10, 3}, {-11, 12, -3}})));
  EXPECT_NEAR(section(small, 1), 1, 1e-9);
}

// Cuts that overlap: the strip between them carries by its own width, along faces that are parallel
// to the load.
TEST(LoadPath, AStripAcrossTheLoadCarriesByItsThickness)
{
  const SmallBody small(small_scene(cuts({{-12, 5, 2}, {-5, 12, -2}})));
  EXPECT_NEAR(section(small, 1), 4, 1e-9);
}

TEST(LoadPath, AMeshHoldsTogether)
{
  const SmallBody small(
      small_scene({"/discrete_zone=none", "/far_field/levels=1", "/far_field/cells_per_level=2"}));
  EXPECT_TRUE(std::isinf(section(small, 0)));
  EXPECT_TRUE(std::isinf(section(small, 1)));
}

/// A body without lateral contraction, of which only the faces bear a tension that are opened.
struct OpenedPlate
{
  explicit OpenedPlate(const std::vector<std::string> &overrides)
      : small(small_scene(
            std::vector<std::string>{
                R"(/discrete_zone/packing="square")", "/material/poissons_ratio=0",
                "/far_field=none",
                R"(/material/fracture={"criterion": "face_tension", "strength": 1e-3})"} +
            overrides))
  {
  }

  /// Opens the faces in the middle between these places.
  std::optional<double> open(double from, double to)
  {
    auto &state = small.body.zone->state;
    for (int i = 0; i < state.size(); ++i)
      if (state.reference[1][i] > 0 && state.reference[0][i] > from && state.reference[0][i] < to)
        state.displacement[1][i] = 2e-3;
    small.body.force()->compute(state, ++time);
    return path.lost(small.body);
  }

  SmallBody small;
  LoadPath<2> path{1};
  double time = 0;
};

TEST(LoadPath, IsLostWhenAFewPerCentOfTheSectionOfTheStartAreLeft)
{
  OpenedPlate plate({"/specimen/cracks=[{\"points\": [[-12, 0], [-2, 0]]}]"});
  const auto &body = plate.small.body;
  EXPECT_FALSE(plate.path.lost(body));
  EXPECT_FALSE(plate.open(-12, 0)); // 12 of 14 are left
  EXPECT_FALSE(plate.open(0, 11));  // 1 of 14: more than 5 %
  EXPECT_EQ(body.force()->broken_bonds().size(), 13u);
  EXPECT_NEAR(section(plate.small, 1), 1, 1e-9);
  EXPECT_NEAR(smallest_section(body, 1, Carrying::at_start), 14, 1e-9);
  const auto left = plate.open(11, 12);
  ASSERT_TRUE(left);
  EXPECT_EQ(*left, 0);
}

TEST(LoadPath, IsNeverLostWhereTheMeshGoesRoundTheZone)
{
  OpenedPlate plate({R"(/specimen/size=[60, 60])", R"(/far_field={"cell_size": 4.1})",
                     R"(/discrete_zone/region={"lower": [-20, -20], "upper": [20, 20]})"});
  EXPECT_TRUE(std::isinf(section(plate.small, 1)));
  EXPECT_FALSE(plate.open(-3, 3));
  EXPECT_FALSE(plate.small.body.force()->broken_bonds().empty());
  EXPECT_FALSE(plate.open(-6, 6));
}

TEST(LoadPath, IsLostWithABridgeOfAFewBonds)
{
  OpenedPlate plate({});
  EXPECT_FALSE(plate.open(-12, 10)); // 2 of 24 are left
  const auto left = plate.open(10, 11);
  ASSERT_TRUE(left); // 1 of 24: less than 5 %
  EXPECT_NEAR(*left, 1 / 24., 1e-9);
}
} // namespace
