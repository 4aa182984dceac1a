// Loads steered by servos through whole runs: they hold their courses, whoever writes how often,
// and runs that are built anew or resumed go the same way to the last bit.
#include "tests/support/run_results.h"

#include <fstream>

using namespace ligament::tests;
namespace fs = std::filesystem;

namespace
{
// A plate with an edge crack, in units of d = 1, E = 1, rho = 1: a machine opens its mouth, another
// one keeps the mean stress of a part of its side, and the other side is under a pressure.
const std::string opened = R"({
  "title": "opened",
  "dimension": 2,
  "specimen": {"size": [40, 120], "cracks": [{"points": [[-20, 0], [-8, 0]]}]},
  "material": {
    "youngs_modulus": 1, "poissons_ratio": 0.22, "density": 1,
    "fracture": {"criterion": "maximum_tension", "strength": 2e-3}
  },
  "discrete_zone": {
    "region": {"lower": [null, -24], "upper": [null, 24]}, "packing": "hexagonal", "spacing": 1
  },
  "far_field": {"cell_size": 4.1},
  "coupling": {"overlap_cells": 2, "transition_cells": 3, "step_ratio": 2},
  "damping": {"mass": 2e-3},
  "gauges": [
    {"name": "mouth", "kind": "opening", "points": [[-19, -1], [-19, 1]], "direction": [0, 1]}
  ],
  "loads": [
    {"boundary": "bottom", "displacement": [null, 0]},
    {"boundary": "top", "velocity": [0, 5e-3],
     "servo": {"gauge": "mouth", "value": 0.06, "ramp": 4000, "gain": 0.5, "response_time": 300}},
    {"boundary": "right", "velocity": [-1e-3, null], "within": {"lower": [null, -10], "upper": [null, 10]},
     "servo": {"stress": -2e-5, "ramp": 2000, "response_time": 300}},
    {"boundary": "left", "pressure": 2e-5, "ramp": 2000, "within": {"lower": [null, -13], "upper": [null, 13]}}
  ],
  "time": {"duration": 5000},
  "output": {"history_interval": 50, "progress_interval": 1e9, "checkpoint_interval": 1e-9}
})";

class Servo : public testing::Test
{
protected:
  static void SetUpTestSuite()
  {
    fs::remove_all("servo");
    fs::create_directory("servo");
    fs::current_path("servo");
    std::ofstream("scene.json") << opened;
    const Outcome outcome = run_ligament("run scene.json -o whole");
    ASSERT_EQ(outcome.code, 0) << outcome.output << outcome.errors;
  }
  static void TearDownTestSuite() { fs::current_path(".."); }
};

double figure(const std::string &run, const std::string &name)
{
  return file_json(run + "/run.json")["figures"][name]["value"];
}

// Nothing may break here: a crack of this law runs through within a few transits of a wave.
TEST_F(Servo, HoldsItsCourse)
{
  const Outcome outcome =
      run_ligament("run scene.json -o elastic --set /material/fracture/strength=0.4");
  ASSERT_EQ(outcome.code, 0) << outcome.output << outcome.errors;
  EXPECT_LT(figure("elastic", "servo_1_rms_error"), 0.02);
  EXPECT_LT(figure("elastic", "servo_1_largest_error"), 0.05);
}

TEST_F(Servo, BooksItsWorkWhileTheCrackGrows)
{
  const auto record = file_json("whole/run.json");
  EXPECT_GT(record["broken_bonds"], 5);
  // What the same scene has under a plain velocity.
  EXPECT_LT(std::abs(double(record["energy_residual"])), 1e-5);
  const std::string head = file_text("whole/history.csv").substr(0, 400);
  EXPECT_NE(head.find("servo_1_error"), head.npos) << head;
}

TEST_F(Servo, SteersWhoeverWritesHowOften)
{
  const Outcome outcome =
      run_ligament("run scene.json -o seldom --set /output/history_interval=770");
  ASSERT_EQ(outcome.code, 0) << outcome.output << outcome.errors;
  for (const char *name : {"servo_1_rms_error", "servo_2_largest_error"})
    EXPECT_EQ(figure("seldom", name), figure("whole", name)) << name;
}

TEST_F(Servo, GoesOnToTheLastBit)
{
  const auto done = [](const Outcome &outcome) {
    ASSERT_EQ(outcome.code, 0) << outcome.output << outcome.errors;
  };
  done(run_ligament("run scene.json -o anew --rebuild-interval 100"));
  expect_same("anew", "whole");
  done(run_ligament("run scene.json -o resumed --set /time/duration=4100"));
  done(run_ligament("resume resumed --set /time/duration=5000"));
  expect_same("resumed", "whole");
}

// A machine that is too slow says so.
TEST_F(Servo, WarnsOfACourseThatItDidNotHold)
{
  const Outcome outcome =
      run_ligament("run scene.json -o slow --set '/loads/1/velocity=[0, 2e-6]'");
  ASSERT_EQ(outcome.code, 0) << outcome.output << outcome.errors;
  EXPECT_NE(outcome.errors.find("allow"), std::string::npos) << outcome.errors;
  EXPECT_GT(figure("slow", "servo_1_rms_error"), 0.3);
  EXPECT_NE(file_text("slow/run.log").find("servo of load 1 did not hold its course"),
            std::string::npos);
}
} // namespace
