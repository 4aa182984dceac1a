// What set-up warns of: each where it is so, and where it is nearly so not.
#include "src/simulation/doubts.h"
#include "tests/support/small_plate.h"

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
using Overrides = std::vector<std::string>;

const Overrides pure = {"/far_field=none"};

std::vector<std::string> doubts(const Overrides &overrides)
{
  const Scene scene = small_scene(overrides);
  const SmallBody small(scene);
  core::Log log;
  doubt_body(scene, small.body, log);
  return log.warnings();
}

/// The only one of them.
std::string doubt(const Overrides &overrides)
{
  const auto all = doubts(overrides);
  EXPECT_EQ(all.size(), 1u);
  return all.empty() ? "" : all[0];
}

bool has(const std::string &text, const std::string &part)
{
  return text.find(part) != std::string::npos;
}

TEST(Doubts, EveryCrackCutsFaces)
{
  const Overrides two = {
      R"(/specimen/notches=[{"lower": [-12, -2], "upper": [-2, 2]}])",
      R"(/specimen/cracks=[{"points": [[-4, 0.1], [5, 0.1]]}, {"points": [[-9, 0], [-5, 0]]}])"};
  EXPECT_TRUE(has(doubt(two), "no face is cut by /specimen/cracks/1"));
  EXPECT_TRUE(doubts({R"(/specimen/cracks=[{"points": [[-4, 0.1], [5, 0.1]]}])"}).empty());
}

TEST(Doubts, CutsLeaveOnePiece)
{
  const auto crack = [](double end) {
    return fmt::format(R"(/specimen/cracks=[{{"points": [[-12, 0.1], [{}, 0.1]]}}])", end);
  };
  for (const Overrides &far : {Overrides(), pure}) {
    EXPECT_TRUE(has(doubt(far + Overrides{crack(12)}), "in 2 pieces from the beginning"));
    EXPECT_TRUE(doubts(far + Overrides{crack(9)}).empty());
    EXPECT_TRUE(
        has(doubt(far + Overrides{R"(/specimen/notches=[{"lower": [-13, -1], "upper": [13, 1]}])"}),
            "in 2 pieces from the beginning"));
  }
}

TEST(Doubts, MotionsMoveSomething)
{
  const auto motion = [](double width) {
    return fmt::format(
        R"(/initial_motion=[{{"velocity": [1e-3, 0], "within": {{"lower": [0.3, 0.3], "upper": [{0}, {0}]}}}}])",
        0.3 + width);
  };
  EXPECT_TRUE(has(doubt({motion(0.01)}), "/initial_motion/0 moves nothing"));
  EXPECT_TRUE(doubts({motion(2)}).empty());
}

TEST(Doubts, ABodyCanComeToTheEndThatItWaitsFor)
{
  const Overrides waits = {
      R"(/time/stop_when="specimen_broken")",
      R"(/material/fracture={"criterion": "maximum_tension", "strength": 1e-3})",
      R"(/loads=[{"boundary": "top", "velocity": [null, 1e-5]}])"};
  EXPECT_TRUE(doubts(waits).empty());
  EXPECT_TRUE(doubts(waits + pure).empty());
  const Overrides around = {"/specimen/size=[120, 120]",
                            R"(/discrete_zone/region={"lower": [-20, -20], "upper": [20, 20]})"};
  EXPECT_TRUE(has(doubt(waits + around), "the mesh, which does not break, joins its two ends"));
  EXPECT_TRUE(has(doubt(waits + Overrides{R"(/discrete_zone="none")"}), "joins its two ends"));
  const Overrides disc = {
      R"(/specimen={"outline": [{"at": [12, 0], "centre": [0, 0], "side": "rim"}]})",
      R"(/loads=[{"boundary": "rim", "traction": [null, 1e-5]}])"};
  EXPECT_TRUE(has(doubt(waits + pure + disc), "nothing joins two flat sides"));
}
} // namespace
