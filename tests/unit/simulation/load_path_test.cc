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

// The sides are those of the body, wherever the origin lies.
TEST(LoadPath, SidesAreFoundAwayFromTheOrigin)
{
  for (const double y : {-120, -60, 0, 500})
    for (const auto &far : {"/coupling/overlap_cells=2", "/far_field=none"}) {
      SCOPED_TRACE(fmt::format("{} {}", far, y));
      const SmallBody small(small_scene(
          {fmt::format(R"(/specimen={{"outline": [{{"at": [3, {0}]}}, {{"at": [27, {0}]}},
                                                 {{"at": [27, {1}]}}, {{"at": [3, {1}]}}]}})",
                       y, y + 120),
           fmt::format(R"(/discrete_zone/region={{"lower": [null, {}], "upper": [null, {}]}})",
                       y + 40, y + 80),
           fmt::format(R"(/specimen/cracks=[{{"points": [[5, {0}], [13, {0}]]}}])", y + 60), square,
           far}));
      EXPECT_NEAR(section(small, 1), 24 - 8, 1e-9);
      EXPECT_NEAR(section_at_least(small.body, 1, Carrying::at_start), 24 - 8, 1e-9);
    }
}

// The bound without a graph: never above the section, in whatever packing, and equal to it where
// nothing is cut; it loses about as much as the cuts have of width.
TEST(LoadPath, ABoundIsNeverAboveTheSection)
{
  const std::vector<std::string> holes = {
      R"(/specimen/holes=[{"centre": [-5, 0], "radius": 3}, {"centre": [5, 0.5], "radius": 2.5}])"};
  for (const auto &far : {"/coupling/overlap_cells=2", "/far_field=none"})
    for (const char *packing :
         {R"("square")", R"("hexagonal")", R"("hexagonal", "orientation": 0.3)",
          R"("random", "seed": 3)", R"("random", "seed": 4, "size_ratio": 3)"})
    {
      SCOPED_TRACE(std::string(far) + " " + packing);
      const auto with = [&](const std::vector<std::string> &more) {
        const std::string zone = fmt::format(
            R"(/discrete_zone={{"region": {{"lower": [null, -20], "upper": [null, 20]}}, "spacing": 1, "packing": {}}})",
            packing);
        return SmallBody(small_scene(std::vector<std::string>{zone, far} + more));
      };
      for (const auto &[more, lost] :
           {std::pair(std::vector<std::string>{}, 0.),
            std::pair(
                std::vector<std::string>{R"(/specimen/cracks=[{"points": [[-4, 0], [4, 2]]}])"},
                8.),
            std::pair(holes, 11.)})
      {
        const SmallBody small = with(more);
        const double bound = section_at_least(small.body, 1, Carrying::at_start);
        EXPECT_LE(bound, section(small, 1) * (1 + 1e-12));
        EXPECT_GT(bound, 24 - 1.3 * lost - (lost > 0 ? 2 : 1e-9));
        EXPECT_LT(bound, 24 - 0.7 * lost + 1e-9);
      }
    }
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

// No side of a disc is flat: nothing is known of what joins its ends.
TEST(LoadPath, OfADiscIsNeverLost)
{
  OpenedPlate disc({R"(/specimen={"outline": [{"at": [12, 0], "centre": [0, 0]},
                                              {"at": [-12, 0], "centre": [0, 0]}]})"});
  EXPECT_FALSE(disc.open(-3, 3));
  EXPECT_FALSE(disc.small.body.force()->broken_bonds().empty());
  EXPECT_FALSE(disc.open(-13, 13));
}

TEST(LoadPath, IsNeverLostWhereTheMeshGoesRoundTheZone)
{
  OpenedPlate plate({R"(/specimen/size=[60, 60])", R"(/far_field={"cell_size": 4.1})",
                     R"(/discrete_zone/region={"lower": [-20, -20], "upper": [20, 20]})"});
  EXPECT_TRUE(std::isinf(section(plate.small, 1)));
  EXPECT_TRUE(std::isinf(section_at_least(plate.small.body, 1, Carrying::now)));
  EXPECT_FALSE(plate.open(-3, 3));
  EXPECT_FALSE(plate.small.body.force()->broken_bonds().empty());
  EXPECT_FALSE(plate.open(-6, 6));
}

// A path that has had a bound only takes over one that knows the section: what it saves is that.
TEST(LoadPath, IsTakenOverByOneThatHadABound)
{
  OpenedPlate intact({}), // a bound is enough
      strip(
          {R"(/specimen/cracks=[{"points": [[-12, 2], [5, 2]]}, {"points": [[-5, -2], [12, -2]]}])"});
  EXPECT_FALSE(intact.open(-12, -8));
  EXPECT_FALSE(strip.open(-1, 1)); // the bound is 0
  core::State bound, known, taken;
  intact.path.save(bound);
  strip.path.save(known);
  EXPECT_EQ(core::load_real(bound, "recorder", "section_at_start"), -1);
  EXPECT_NEAR(core::load_real(known, "recorder", "section_at_start"), 4, 1e-9);
  LoadPath<2> &other = intact.path;
  other.load(known);
  other.save(taken);
  EXPECT_EQ(core::load_real(taken, "recorder", "section_at_start"),
            core::load_real(known, "recorder", "section_at_start"));
  EXPECT_EQ(core::load_real(taken, "recorder", "section_at_least"),
            core::load_real(known, "recorder", "section_at_least"));
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
