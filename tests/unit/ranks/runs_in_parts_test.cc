// Whole runs by all ranks together and by one process beside them: files and records are the same,
// byte for byte, under what acts on all masses, lets waves out, follows the surface or is steered.
#include "src/simulation/simulation.h"
#include "tests/support/ranks.h"
#include "tests/support/small_plate.h"

#include <filesystem>
#include <fstream>
#include <sstream>

namespace ligament::program
{
namespace
{
using test::ranks;
using tests::operator+;
using Overrides = std::vector<std::string>;

const Overrides broken = {
    R"(/specimen/cracks=[{"points": [[-13, 0], [-3, 0]]}])",
    R"(/material/fracture={"criterion": "maximum_tension", "strength": 6e-4})",
    "/discrete_zone/orientation=0.2",
    R"(/gauges=[
      {"name": "pieces", "kind": "fragments"},
      {"name": "mouth", "kind": "opening", "points": [[-11, -1], [-11, 1.2]], "direction": [0, 1]},
      {"name": "tip", "kind": "j_integral", "direction": [1, 0], "lower": [-9, -16], "upper": [9, 16],
       "inner_lower": [-5, -5], "inner_upper": [3, 5]}])",
    "/coupling/guard=warn",
    "/coupling/regime=linear",
    "/time/duration=150"};

/// Falls; a servo opens the crack, waves leave at the bottom, a side is pressed.
const Overrides all_loads = {R"(/body_force={"acceleration": [4e-6, -2e-5], "ramp": 15})",
                             R"(/loads=[
      {"boundary": "top", "velocity": [null, 2e-2],
       "servo": {"gauge": "mouth", "value": 0.3, "ramp": 60, "gain": 0.5, "response_time": 30}},
      {"boundary": "bottom", "absorbing": true, "absorbing_layer": 6},
      {"boundary": "right", "pressure": 4e-4, "ramp": 30,
       "within": {"lower": [null, -7], "upper": [null, 7]}}])"};

/// One machine keeps the stress of its side.
const Overrides stress_held = {
    R"(/loads=[
      {"boundary": "top", "velocity": [null, 2e-2],
       "servo": {"stress": 2e-3, "ramp": 40, "response_time": 30}},
      {"boundary": "bottom", "displacement": [null, 0]}])"};

std::string text_of(const std::string &path)
{
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Built anew every so many steps of the far field, 0: never.
RunRecord run(const core::Ranks &by, const std::string &folder, const Overrides &overrides,
              int rebuild_interval)
{
  const RunFolder place{folder};
  if (by.is_first()) {
    std::filesystem::remove_all(folder);
    place.create();
  }
  by.any(false);
  const ReadResult input = parse_scene(tests::small_plate, "plate", overrides);
  for (const auto &error : input.errors)
    ADD_FAILURE() << core::to_string(error);
  std::FILE *quiet = std::fopen("/dev/null", "w");
  Simulation<2> simulation(input.scene.value(), place, quiet, false, nullptr,
                           make_many_body_force<2>, by);
  simulation.rebuild_every(rebuild_interval);
  const RunRecord record = simulation.run();
  std::fclose(quiet);
  by.any(false); // all is written
  return record;
}

void expect_the_run_of_one_process(const Overrides &overrides, int rebuild_interval = 0)
{
  const std::string together = "runs_together_" + std::to_string(ranks().size()),
                    alone = "run_alone_" + std::to_string(ranks().size()) + "_" +
                            std::to_string(ranks().rank());
  const RunRecord record = run(ranks(), together, broken + overrides, rebuild_interval),
                  twin = run({}, alone, broken + overrides, 0);
  EXPECT_EQ(record.status, "done") << record.reason;
  EXPECT_GT(record.broken_bonds, 3); // else the test would say little
  EXPECT_EQ(record.steps, twin.steps);
  for (const char *name : {"history.csv", "broken_bonds.csv", "fragments.csv"}) {
    const std::string text = text_of(alone + "/" + name);
    EXPECT_FALSE(text.empty()) << name;
    EXPECT_TRUE(text_of(together + "/" + name) == text) << name;
  }
  for (const auto &[name, figure] : twin.figures)
    if (name.find("servo") == 0) {
      EXPECT_EQ(record.figures.at(name).value, figure.value) << name;
    }
  ranks().any(false); // all have read the files
}

TEST(RunsInParts, InsideAMeshUnderAllLoads)
{
  expect_the_run_of_one_process(all_loads);
}
TEST(RunsInParts, InsideAMeshUnderAllLoadsCutAnew)
{
  expect_the_run_of_one_process(all_loads, 40);
}
TEST(RunsInParts, OfParticlesAloneUnderAllLoads)
{
  expect_the_run_of_one_process(all_loads + Overrides{"/far_field=none", "/specimen/size=[24, 50]"},
                                60);
}
TEST(RunsInParts, OfParticlesThatReachToTheAbsorbingSide)
{
  expect_the_run_of_one_process(
      all_loads +
          Overrides{R"(/discrete_zone/region={"lower": [null, null], "upper": [null, 20]})"},
      60);
}
TEST(RunsInParts, WhereAServoKeepsAStress)
{
  expect_the_run_of_one_process(stress_held, 50);
}
} // namespace
} // namespace ligament::program
