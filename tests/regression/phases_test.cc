// Runs of several static phases: interrupted, killed and built anew they write byte for byte what a
// run without a break writes; where a body carries no more, they go on by steps and say so.
#include "tests/support/run_results.h"

#include <random>

using namespace ligament::tests;
namespace fs = std::filesystem;

namespace
{
const std::string program = LIGAMENT_PROGRAM;

// A notched plate whose crack meets two tough inclusions: three static phases, and a dynamic one
// behind each of them, in units of d = 1, E = 1, rho = 1. Checkpoints whenever
// one may be due.
const std::string phases = R"({
  "title": "phases",
  "dimension": 2,
  "specimen": {"size": [24, 120], "cracks": [{"points": [[-12, 0], [-6, 0]]}]},
  "material": {
    "youngs_modulus": 1, "poissons_ratio": 0.22, "density": 1,
    "fracture": {"criterion": "maximum_tension", "strength": 1e-3}
  },
  "inclusions": [{
    "boxes": [
      {"lower": [-1, -2.6], "upper": [1.5, 2.6]}, {"lower": [5, -2.6], "upper": [7.5, 2.6]}
    ],
    "youngs_modulus": 1, "poissons_ratio": 0.22, "density": 1,
    "fracture": {"criterion": "maximum_tension", "strength": 4e-3}
  }],
  "discrete_zone": {
    "region": {"lower": [null, -20], "upper": [null, 20]}, "packing": "hexagonal", "spacing": 1
  },
  "far_field": {"cell_size": 4.1},
  "coupling": {"overlap_cells": 2, "transition_cells": 3, "step_ratio": 2},
  "damping": {"local": 0.3},
  "loads": [
    {"boundary": "top", "velocity": [null, 1e-6], "ramp": 1e4},
    {"boundary": "bottom", "velocity": [null, -1e-6], "ramp": 1e4}
  ],
  "time": {"duration": 2.8e4, "loading": "static"},
  "output": {
    "history_interval": 100, "field_interval": "never", "progress_interval": 1000,
    "checkpoint_interval": 1e-9
  }
})";

bool has(const std::string &text, const std::string &part)
{
  return text.find(part) != std::string::npos;
}

/// /phases of a run's record, without what a clock on the wall says.
nlohmann::json phases_of(const std::string &run)
{
  auto list = file_json(run + "/run.json")["phases"];
  for (auto &phase : list)
    phase.erase("seconds");
  return list;
}

std::string set(const std::string &key, const std::string &value)
{
  return " --set '" + key + "=" + value + "'";
}

class Phases : public testing::Test
{
protected:
  static void SetUpTestSuite()
  {
    fs::remove_all("phases");
    fs::create_directory("phases");
    fs::current_path("phases");
    std::ofstream("scene.json") << phases;
    ASSERT_EQ(run_ligament("run scene.json -o whole").code, 0);
    const auto list = phases_of("whole");
    ASSERT_GE(list.size(), 5u) << list.dump(1);
    long steps = 0;
    for (const auto &phase : list)
      steps += long(phase["steps"]);
    ASSERT_GT(steps, 1000);
    ASSERT_GE(file_json("whole/run.json")["broken_bonds"], 20);
  }
  static void TearDownTestSuite() { fs::current_path(".."); }

  /// A run with these overrides, to its end.
  static nlohmann::json record_of(const std::string &name, const std::string &overrides)
  {
    const Outcome outcome = run_ligament("run scene.json -o " + name + overrides);
    EXPECT_EQ(outcome.code, 0) << outcome.output << outcome.errors;
    return file_json(name + "/run.json");
  }
};

// Signals end a run in the next step that is computed: in the middle of a dynamic phase, or right
// behind a static one.
TEST_F(Phases, InterruptedInEitherPhaseNothingDiffers)
{
  std::mt19937 random(std::random_device{}());
  const double whole = file_json("whole/run.json")["wall_seconds"];
  std::uniform_real_distribution<double> seconds(0, 1.2 * whole);
  int behind_static = 0, in_dynamic = 0;
  for (int attempt = 0; attempt < 100 && (behind_static < 3 || in_dynamic < 3); ++attempt) {
    fs::remove_all("cut");
    Process process("exec " + program + " run scene.json -o cut");
    ASSERT_TRUE(eventually([] { return fs::exists("cut/history.csv"); }));
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds(random)));
    process.send(SIGTERM);
    if (process.wait().code != 128 + SIGTERM || newest_checkpoint("cut").empty())
      continue;
    const long step = file_json("cut/run.json")["steps"];
    const auto last = phases_of("cut").back();
    if (last["kind"] != "dynamic" || step == 0)
      continue;
    (long(last["steps"]) <= 4 ? behind_static : in_dynamic) += 1;
    const Outcome more = run_ligament("resume cut");
    ASSERT_EQ(more.code, 0) << more.errors;
    expect_same("cut", "whole");
    EXPECT_EQ(phases_of("cut"), phases_of("whole")) << "interrupted in step " << step;
    const auto record = file_json("cut/run.json");
    double seconds_of_phases = 0; // of both processes
    for (const auto &phase : record["phases"])
      seconds_of_phases += double(phase["seconds"]);
    EXPECT_GT(seconds_of_phases, 0.8 * double(record["wall_seconds"]));
    if (HasFailure())
      return;
  }
  EXPECT_GE(behind_static, 3);
  EXPECT_GE(in_dynamic, 3);
}

TEST_F(Phases, BuiltAnewUnderWayNothingDiffers)
{
  for (const char *interval : {"7", "100"}) {
    SCOPED_TRACE(interval);
    const std::string run = std::string("rebuilt_") + interval;
    ASSERT_EQ(
        run_ligament("run scene.json --rebuild-interval " + std::string(interval) + " -o " + run)
            .code,
        0);
    EXPECT_TRUE(has(file_text(run + "/run.log"), "built anew "));
    expect_same(run, "whole");
    EXPECT_EQ(phases_of(run), phases_of("whole"));
  }
}

// Between two bonds there is no step: signals and checkpoints come between two equilibria.
TEST_F(Phases, BondByBondInterruptedAndBuiltAnewNothingDiffers)
{
  const std::string bonds = set("/time/loading", "\"sequential\"") + set("/inclusions", "[]");
  ASSERT_EQ(run_ligament("run scene.json -o bonds" + bonds).code, 0);
  ASSERT_GE(file_json("bonds/run.json")["broken_bonds"], 10);
  std::mt19937 random(std::random_device{}());
  std::uniform_real_distribution<double> seconds(0, file_json("bonds/run.json")["wall_seconds"]);
  int hits = 0;
  for (int attempt = 0; attempt < 100 && hits < 3; ++attempt) {
    fs::remove_all("cut");
    Process process("exec " + program + " run scene.json -o cut" + bonds);
    ASSERT_TRUE(eventually([] { return fs::exists("cut/history.csv"); }));
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds(random)));
    process.send(SIGTERM);
    if (process.wait().code != 128 + SIGTERM || newest_checkpoint("cut").empty() ||
        phases_of("cut").back()["kind"] != "static")
      continue;
    ++hits;
    const Outcome more = run_ligament("resume cut");
    ASSERT_EQ(more.code, 0) << more.errors;
    expect_same("cut", "bonds");
    EXPECT_EQ(phases_of("cut"), phases_of("bonds"));
    if (HasFailure())
      return;
  }
  EXPECT_EQ(hits, 3);
  ASSERT_EQ(run_ligament("run scene.json -o anew --rebuild-interval 1" + bonds).code, 0);
  expect_same("anew", "bonds");
}

// One bond holds the halves together; behind it they are two free bodies, and nothing loads them.
TEST_F(Phases, ABodyThatItsFirstBreakCutsInTwo)
{
  for (const std::string &far :
       {std::string(), " --set /far_field=none" + set("/damping", R"({"mass": 0.02})")})
  {
    const auto record =
        record_of(far.empty() ? "halves" : "pure_halves",
                  far +
                      set("/specimen",
                          R"({"size": [24, 120], "cracks": [{"points": [[-12, 0], [11, 0]]}]})") +
                      set("/inclusions", "[]"));
    EXPECT_EQ(record["status"], "done");
    EXPECT_EQ(record["broken_bonds"], 1);
    const auto &list = record["phases"];
    ASSERT_GE(list.size(), 3u) << list.dump(1);
    EXPECT_EQ(list[0]["reason"], "a bond bears its strength");
    EXPECT_EQ(list[0]["broken"], 1);
    // Halves that follow their grips without strain have but the energy of their motion.
    EXPECT_EQ(list[1]["reason"], "the body is calm");
    EXPECT_EQ(list[2]["reason"], "end of the run");
    EXPECT_LT(std::abs(double(list[2]["load"])), 1e-6 * double(list[0]["load"]));
  }
}

// One bond after the other, between two equilibria each: steps are passed over, none is done.
TEST_F(Phases, BondByBondAllIsStatic)
{
  const auto record =
      record_of("sequential", set("/time/loading", "\"sequential\"") + set("/inclusions", "[]"));
  const auto &list = record["phases"];
  ASSERT_GE(list.size(), 4u) << list.dump(1);
  for (std::size_t k = 0; k + 1 < list.size(); ++k) {
    if (list[k]["reason"] == "the body no longer carries" || list[k]["kind"] != "static") {
      EXPECT_GE(k, 3u) << list.dump(1);
      break;
    }
    EXPECT_EQ(list[k]["end"], list[k + 1]["begin"]) << k;
    EXPECT_EQ(list[k]["steps"], 0) << k;
    EXPECT_EQ(list[k]["broken"], 1) << k;
  }
}
} // namespace
