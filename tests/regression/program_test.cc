// The program from outside: exit codes, fields of --json, older runs are kept.
#include "tests/support/slowness.h"
#include "tests/support/small_plate.h"

#include <nlohmann/json.hpp>

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

using namespace ligament::tests;

namespace
{
struct Outcome
{
  int code;
  std::string last_line; // of standard output
  std::string output;    // all of it
  nlohmann::json json() const { return nlohmann::json::parse(last_line); }
};

Outcome ligament(const std::string &arguments)
{
  std::FILE *pipe = popen((LIGAMENT_PROGRAM " " + arguments + " 2>/dev/null").c_str(), "r");
  Outcome outcome{-1, "", ""};
  std::string line;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) {
    outcome.output += char(c);
    if (c == '\n') {
      outcome.last_line = line;
      line.clear();
    } else
      line += char(c);
  }
  outcome.code = WEXITSTATUS(pclose(pipe));
  return outcome;
}

/// A file of the small plate, pulled for `duration`.
std::string scene_file(const std::string &name)
{
  std::ofstream(name) << small_plate;
  return name;
}

const std::string pulled =
    R"( --set '/loads=[{"boundary": "top", "velocity": [null, 1e-4], "ramp": 50}]' )";
const std::string weak =
    R"( --set '/material/fracture={"criterion": "maximum_tension", "strength": 1e-5}' )";

std::vector<std::string> missing(const nlohmann::json &json, const std::vector<std::string> &names)
{
  std::vector<std::string> result;
  for (const auto &name : names)
    if (!json.contains(name))
      result.push_back(name);
  return result;
}

TEST(Program, RunEndsWithTheFieldsThatScriptsRead)
{
  std::filesystem::remove_all("run");
  const auto outcome = ligament("run " + scene_file("run.json") + pulled + "--output run --json");
  EXPECT_EQ(outcome.code, 0);
  const auto json = outcome.json();
  EXPECT_EQ(missing(json, {"status", "steps", "wall_seconds", "peak_load", "broken_bonds",
                           "energy_residual", "output"}),
            std::vector<std::string>());
  EXPECT_EQ(json["status"], "done");
  EXPECT_GT(json["steps"], 0);
  EXPECT_TRUE(json["peak_load"].is_null()) << "nothing can break";
  EXPECT_GT(json["largest_load"], 0);
  EXPECT_EQ(json["complete"], true);
  for (const char *file : {"run.json", "run.log", "history.csv", "scene.resolved.json",
                           "report.html", "broken_bonds.csv"})
    EXPECT_TRUE(std::filesystem::exists(std::string("run/") + file)) << file;
}

// Nobody knows how many phases there will be: the only prediction is that of a run by steps alone.
TEST(Program, CheckPredictsNoTimeOfPhases)
{
  const std::string scene = scene_file("check_phases.json");
  const auto checked = ligament("check " + scene + pulled +
                                "--set /time/loading=static --set /damping/mass=0.01 "
                                "--set /time/duration=1e9 --json");
  EXPECT_EQ(checked.code, 0);
  const auto json = checked.json();
  EXPECT_TRUE(json["predicted_seconds"].is_null());
  EXPECT_TRUE(json["phases"].is_null());
  EXPECT_EQ(json["loading"], "static");
  EXPECT_GT(json["steps"], 1e8);
  EXPECT_TRUE(json["output_seconds"].is_null());
  EXPECT_GT(json["dynamic_seconds"], 0);
  // Particles that are no pads have two displacements and a spin, free nodes two displacements.
  const int particles = json["particles"], cells = json["cells"];
  EXPECT_GT(json["equilibrium"]["unknowns"], 2 * particles);
  EXPECT_LT(json["equilibrium"]["unknowns"], 3 * particles + 2 * 4 * cells);
  EXPECT_NE(checked.output.find("unknown number of phases"), std::string::npos) << checked.output;
  EXPECT_NE(checked.output.find("of a purely dynamic run"), std::string::npos) << checked.output;
}

// Particles have two displacements and a rotation, nodes of the mesh of 6 x 29 cells two
// displacements, and one where the load holds the other.
TEST(Program, CheckCountsTheUnknownsOfAnEquilibrium)
{
  const std::string check = "check " + scene_file("unknowns.json") + pulled +
                            "--set /time/loading=static --set /damping/mass=0.01 --json ";
  const auto discrete = ligament(check + "--set /far_field=none").json();
  EXPECT_EQ(discrete["equilibrium"]["unknowns"], 3 * int(discrete["particles"]));
  const auto mesh = ligament(check + "--set /discrete_zone=none").json();
  ASSERT_EQ(mesh["cells"], 6 * 29);
  EXPECT_EQ(mesh["equilibrium"]["unknowns"], 2 * 7 * 30 - 7);
}

// Too large to be solved for a check: at the least, two copies of a matrix of seven blocks a row.
TEST(Program, CheckCountsTheMemoryOfEquilibria)
{
  const std::string check = "check " + scene_file("large_phases.json") + pulled +
                            "--set /far_field=none --set /specimen/size=[350,350] "
                            "--set /damping/mass=0.01 --json ";
  const auto dynamic = ligament(check).json(),
             phases = ligament(check + "--set /time/loading=static").json();
  const double unknowns = phases["equilibrium"]["unknowns"];
  ASSERT_GT(unknowns, 300000);
  EXPECT_TRUE(phases["equilibrium"]["seconds"].is_null());
  EXPECT_GT(phases["memory_bytes"].get<double>() - dynamic["memory_bytes"].get<double>(),
            2 * 7 * 3 * sizeof(double) * unknowns);

  // The first of several ranks alone needs it, unless all of them help.
  const std::string on_ranks = check + "-n 2 --set /time/loading=static ";
  const auto alone = ligament(on_ranks).json()["on_ranks"],
             helped = ligament(on_ranks + "--set /time/static_solver=parallel_multigrid")
                          .json()["on_ranks"];
  const auto beyond_others = [](const nlohmann::json &ranks) {
    return ranks["memory_bytes"].get<double>() - ranks["other_memory_bytes"].get<double>();
  };
  EXPECT_GT(beyond_others(alone), phases["equilibrium"]["memory_bytes"].get<double>());
  EXPECT_LT(beyond_others(helped),
            beyond_others(alone) - 0.4 * phases["equilibrium"]["memory_bytes"].get<double>());
}

TEST(Program, CheckAndCompareEndWithTheFieldsThatScriptsRead)
{
  const std::string scene = scene_file("check.json");
  const auto checked = ligament("check " + scene + pulled + "--json");
  EXPECT_EQ(checked.code, 0);
  EXPECT_EQ(missing(checked.json(), {"particles", "cells", "overlap_particles", "dt", "dt_critical",
                                     "steps", "memory_bytes", "errors"}),
            std::vector<std::string>());
  EXPECT_TRUE(checked.json()["errors"].empty());
  EXPECT_GT(checked.json()["predicted_seconds"], 0);
  EXPECT_FALSE(checked.json().contains("equilibrium"));

  std::filesystem::remove_all("a");
  std::filesystem::remove_all("b");
  ligament("run " + scene + pulled + "--output a");
  ligament("run " + scene + pulled + "--set /far_field=none --output b");
  const auto compared = ligament("compare a b --json");
  EXPECT_EQ(compared.code, 0);
  EXPECT_EQ(missing(compared.json(),
                    {"peak_load_error", "stiffness_error", "crack_distance_mean",
                     "crack_distance_max", "energy_error", "time_ratio", "particle_ratio"}),
            std::vector<std::string>());
}

TEST(Program, WrongInputIsTwoAndAGuardIsThree)
{
  const std::string scene = scene_file("codes.json");
  const auto wrong = ligament("check " + scene + " --set /coupling/overlap_widht=3 --json");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_FALSE(wrong.json()["errors"].empty());
  EXPECT_EQ(ligament("run no_such_scene.json").code, 2);

  std::filesystem::remove_all("guarded");
  const auto guarded = ligament("run " + scene + pulled + weak + "--output guarded --json");
  EXPECT_EQ(guarded.code, 3);
  EXPECT_EQ(guarded.json()["status"], "stopped");
}

TEST(Program, RunsThatAreNotCompleteAreThreeWhereverTheyAppear)
{
  const std::string scene = scene_file("incomplete.json");
  for (const char *folder : {"part", "whole"})
    std::filesystem::remove_all(folder);
  ligament("run " + scene + pulled + weak + "--output part");
  ligament("run " + scene + pulled + "--output whole");
  EXPECT_EQ(ligament("report whole --json").code, 0);
  const auto report = ligament("report part --json");
  EXPECT_EQ(report.code, 3);
  EXPECT_EQ(report.json()["complete"], false);
  for (const char *folders : {"part whole", "whole part"}) {
    const auto compared = ligament(std::string("compare ") + folders + " --json");
    EXPECT_EQ(compared.code, 3) << folders;
    EXPECT_EQ(compared.json()["complete"], false);
  }
  EXPECT_EQ(ligament("compare whole whole").code, 0);
}

// What only the set-up can see is refused by `check` too, with the keys to change.
TEST(Program, CheckRefusesWithTheKeyToChange)
{
  const std::string scene = scene_file("refused.json");
  for (const auto &[setting, key] : std::vector<std::pair<std::string, std::string>>{
           {"/coupling/step_ratio=16", "/coupling/step_ratio"},
           {"/coupling/overlap_cells=1", "/coupling/overlap_cells"},
           {"/far_field/cell_size=2.6", "/coupling/overlap_cells"},
           {R"('/discrete_zone/region={"lower": [null, -0.5], "upper": [null, 0.5]}')",
            "/discrete_zone/region"}})
  {
    const auto outcome = ligament("check " + scene + " --set " + setting + " --json");
    EXPECT_EQ(outcome.code, 2) << setting;
    EXPECT_NE(outcome.json()["errors"].dump().find(key), std::string::npos) << outcome.last_line;
  }
}

std::vector<std::string> lines_of(const std::string &file)
{
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);)
    lines.push_back(line);
  return lines;
}

// A run that is asked to end does so behind a look, which has written its last row.
TEST(Program, NoRowIsWrittenTwice)
{
  std::filesystem::remove_all("rows");
  const auto outcome = ligament("run " + scene_file("rows.json") + pulled +
                                "--set /output/history_interval=1e-3 --set /time/duration=1e4 "
                                "--wall-time " +
                                std::to_string(0.3 * slowness) + " --output rows");
  ASSERT_EQ(outcome.code, 124);
  const auto lines = lines_of("rows/history.csv");
  ASSERT_GE(lines.size(), 5u);
  for (std::size_t row = 1; row < lines.size(); ++row)
    EXPECT_NE(lines[row], lines[row - 1]);
}

TEST(Program, NewToStandardOutputEndsWithAnObject)
{
  const auto plain = ligament("new three_point_bending -o -");
  const auto outcome = ligament("new three_point_bending -o - --json");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.output, plain.output + outcome.last_line + "\n");
  EXPECT_EQ(outcome.json()["status"], "done");
  EXPECT_EQ(outcome.json()["kind"], "three_point_bending");
}

TEST(Program, CheckDrawsTheBoxesOfGauges)
{
  const std::string crystal = LIGAMENT_SOURCE_DIR "/tests/support/scenes/crystal.json";
  const auto drawn = [&](const std::string &gauge) {
    std::filesystem::remove_all("drawn");
    const auto outcome =
        ligament("check " + crystal + " --draw -o drawn --set '/gauges=[" + gauge + "]'");
    EXPECT_EQ(outcome.code, 0) << outcome.output;
    std::ifstream in("drawn/check.png", std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const std::string bare = drawn("");
  EXPECT_EQ(drawn(R"({"name": "all", "kind": "virial_stress"})"), bare);
  EXPECT_NE(drawn(R"({"name": "box", "kind": "virial_stress", "lower": [0, 0]})"), bare);
}

// The advice is of other settings of the scene, wherever it lies.
TEST(Program, CheckAdvisesOnPackingsFromFiles)
{
  std::filesystem::remove_all("advised");
  std::filesystem::create_directory("advised");
  scene_file("advised/scene.json");
  const std::string large =
      R"(--set '/discrete_zone/region={"lower": [null, -40], "upper": [null, 40]}' )"
      "--set '/specimen/size=[24, 100]' --set /coupling/overlap_cells=13 "
      "--set /far_field/cell_size=2.5 --set /coupling/step_ratio=1 ";
  ASSERT_EQ(ligament("run advised/scene.json " + large + pulled +
                     "--set /discrete_zone/packing=random --set /time/duration=1 -o advised/run")
                .code,
            0);
  const std::string file = "--set /discrete_zone/packing=file "
                           "--set /discrete_zone/packing_file=run/packing.csv ";
  // What a run has resolved finds the packing from its own folder, too.
  ASSERT_EQ(ligament("run advised/scene.json " + large + pulled + file +
                     "--set /time/duration=1 -o advised/again")
                .code,
            0);
  EXPECT_EQ(ligament("check advised/again/scene.resolved.json").code, 0);
  const auto outcome = ligament("check advised/scene.json --json " + large + pulled + file);
  ASSERT_EQ(outcome.code, 0);
  const auto json = outcome.json();
  if (json["predicted_saving"] < 1) { // it is measured: 0.7 on an idle machine
    EXPECT_GE(json["advice"]["options"].size(), 1u) << json["advice"].dump(1);
  }
}

TEST(Program, AnOlderRunIsKept)
{
  for (const char *folder : {"kept", "kept.1", "kept.2"})
    std::filesystem::remove_all(folder);
  const std::string command = "run " + scene_file("kept.json") + pulled + "--output kept ";
  EXPECT_EQ(ligament(command + "--set /time/duration=50").code, 0);
  EXPECT_EQ(ligament(command + "--set /time/duration=60").code, 0);
  const auto time_of = [](const std::string &folder) {
    std::ifstream in(folder + "/run.json");
    return nlohmann::json::parse(in).at("simulated_time").get<double>();
  };
  // Whole steps of about half a time unit.
  EXPECT_NEAR(time_of("kept.1"), 50, 1);
  EXPECT_NEAR(time_of("kept"), 60, 1);
}

TEST(Program, StopsWhenTheSpecimenIsBroken)
{
  std::filesystem::remove_all("broken");
  const auto outcome =
      ligament("run " + scene_file("broken.json") +
               R"( --set '/loads=[{"boundary": "top", "velocity": [null, 1e-4], "ramp": 50},)"
               R"( {"boundary": "bottom", "velocity": [null, -1e-4], "ramp": 50}]' )"
               R"( --set '/specimen/cracks=[{"points": [[-10, 0], [10, 0]]}]' )"
               R"( --set '/material/fracture={"criterion": "maximum_tension", "strength": 1e-3}' )"
               R"( --set /time/duration=5000 --set /time/stop_when='"specimen_broken"' )"
               "--output broken --json");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.json()["status"], "done");
  std::ifstream in("broken/run.json");
  EXPECT_LT(nlohmann::json::parse(in).at("simulated_time"), 4900);
}

TEST(Program, ARunsPackingCanBeReadAgain)
{
  std::filesystem::remove_all("random");
  const std::string scene = scene_file("random.json") + pulled;
  const auto random = ligament("run " + scene +
                               "--set /discrete_zone/packing='\"random\"' --set "
                               "/discrete_zone/size_ratio=2 --output random --json");
  EXPECT_EQ(random.code, 0);
  std::filesystem::remove_all("read");
  const std::string file = R"(--set /discrete_zone/packing='"file"' --set )"
                           R"(/discrete_zone/packing_file='"random/packing.csv"' )";
  const auto again = ligament("run " + scene + file + "--output read --json");
  EXPECT_EQ(again.code, 0);
  // The same body to round-off: the load is a difference of larger forces.
  const double load = random.json()["largest_load"];
  EXPECT_NEAR(again.json()["largest_load"], load, 1e-9 * load);
  const std::string wrong_spacing = "--set /discrete_zone/spacing=0.8 ";
  EXPECT_EQ(ligament("check " + scene + file + wrong_spacing).code, 2);
  std::ofstream("random/packing.csv") << "x,y,r\nm,m,m\n0,0,none\n";
  EXPECT_EQ(ligament("check " + scene + file).code, 2);
}
} // namespace
