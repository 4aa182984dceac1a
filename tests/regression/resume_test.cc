// Runs that are killed, stopped or short of time, and go on: byte for byte what a run without a
// break writes. Through the programs.
#include "tests/support/faulty_disk.h"
#include "tests/support/run_results.h"

#include <cerrno>
#include <random>

using namespace ligament::tests;
namespace fs = std::filesystem;

namespace
{
const std::string program = LIGAMENT_PROGRAM;

// A plate with a crack is torn apart: bonds break from the middle of the run on, in units of d = 1,
// E = 1, rho = 1. Checkpoints whenever one
// may be due: no interval is longer than a run on a fast machine.
const std::string torn = R"({
  "title": "torn",
  "dimension": 2,
  "specimen": {"size": [24, 120], "cracks": [{"points": [[-4, 0], [4, 0]]}]},
  "material": {
    "youngs_modulus": 1, "poissons_ratio": 0.22, "density": 1, "friction": 0.4,
    "fracture": {"criterion": "maximum_tension", "strength": 1e-3}
  },
  "discrete_zone": {
    "region": {"lower": [null, -20], "upper": [null, 20]}, "packing": "hexagonal", "spacing": 1
  },
  "far_field": {"cell_size": 4.1},
  "coupling": {"overlap_cells": 2, "transition_cells": 3, "step_ratio": 2},
  "loads": [
    {"boundary": "top", "velocity": [null, 2e-4], "ramp": 100},
    {"boundary": "bottom", "velocity": [null, -2e-4], "ramp": 100}
  ],
  "gauges": [
    {"name": "length", "kind": "distance", "points": [[0, -50], [3, 9]]},
    {"name": "mouth", "kind": "opening", "points": [[0, -0.5], [0, 0.5]]},
    {"name": "e", "kind": "strain", "lower": [-6, -6], "upper": [6, 25]},
    {"name": "s", "kind": "stress", "lower": [-6, -6], "upper": [6, 25]},
    {"name": "top", "kind": "force", "side": "top"},
    {"name": "tip_j", "kind": "j_integral", "direction": [1, 0], "lower": [-3, -8], "upper": [11.5, 8],
     "inner_lower": [1, -3], "inner_upper": [7, 3]},
    {"name": "tip", "kind": "crack_tip", "points": [[0, 0]], "direction": [1, 0], "smoothing": 20},
    {"name": "pieces", "kind": "fragments"}
  ],
  "tools": [
    {"name": "ball", "shape": "ball", "radius": 6, "place": [-18.05, 4], "mass": 60, "inertia": 900,
     "initial_velocity": [8e-4, 4e-4], "friction": 0.4},
    {"name": "stamp", "shape": "plate", "size": [3, 2], "place": [13.505, -6], "velocity": [-5e-5, 5e-5],
     "friction": 0.3}
  ],
  "time": {"duration": 400},
  "output": {
    "history_interval": 1.7, "field_interval": 50, "progress_interval": 1000,
    "checkpoint_interval": 1e-9
  }
})";

bool has(const std::string &text, const std::string &part)
{
  return text.find(part) != std::string::npos;
}

/// In a folder of its own, in which the run "whole" had no break.
class Resume : public testing::Test
{
protected:
  static void SetUpTestSuite()
  {
    fs::remove_all("resume");
    fs::create_directory("resume");
    fs::current_path("resume");
    std::ofstream("torn.json") << torn;
    ASSERT_EQ(run_ligament("run torn.json -o whole").code, 0);
    // A test that ends before the first broken bond proves little.
    const auto record = file_json("whole/run.json");
    ASSERT_GE(record["broken_bonds"], 10);
    ASSERT_FALSE(newest_checkpoint("whole").empty());
  }
  static void TearDownTestSuite() { fs::current_path(".."); }

  void SetUp() override
  {
    for (const auto &entry : fs::directory_iterator("."))
      if (entry.path().filename() != "whole" && entry.is_directory())
        fs::remove_all(entry.path());
  }

  /// A run that SIGTERM ends about where the one without a break has half of its rows.
  static void make_half(const std::string &run, const std::string &whole = "whole",
                        const std::string &overrides = "", int least_checkpoints = 2)
  {
    const std::size_t half = fs::file_size(whole + "/history.csv") / 2;
    // On a fast machine it may come to its end before the signal does.
    for (int attempt = 0; attempt < 20; ++attempt) {
      fs::remove_all(run);
      Process process("exec " + program + " run torn.json -o " + run + overrides);
      std::error_code none;
      while (!fs::exists(run + "/history.csv", none) ||
             fs::file_size(run + "/history.csv", none) < half)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      process.send(SIGTERM);
      if (process.wait().code == 128 + SIGTERM &&
          newest_checkpoint(run) >=
              run + "/checkpoints/checkpoint_00000" + std::to_string(least_checkpoints))
        return;
    }
    FAIL() << "always at its end before it can be stopped";
  }
};

/// Kills so many times at random moments, begins and resumes as often as it takes. Returns how many
/// of the kills hit a process.
int kill_and_resume(const std::string &run, int n_kills, std::mt19937_64 &random)
{
  std::uniform_real_distribution<double> seconds(0.02, 0.5);
  int hits = 0;
  for (int k = 0; k < n_kills; ++k) {
    const bool begun = !newest_checkpoint(run).empty();
    if (!begun)
      fs::remove_all(run);
    Process process("exec " + program + (begun ? " resume " + run : " run torn.json -o " + run));
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds(random)));
    process.send(SIGKILL);
    hits += process.wait().code == 128 + SIGKILL;
  }
  if (newest_checkpoint(run).empty()) {
    fs::remove_all(run);
    EXPECT_EQ(run_ligament("run torn.json -o " + run).code, 0);
  } else if (file_json(run + "/run.json").value("status", "") != "done") {
    const Outcome outcome = run_ligament("resume " + run);
    EXPECT_EQ(outcome.code, 0) << outcome.errors;
  }
  return hits;
}

void kill_in_chains(int n_wanted, int n_per_chain)
{
  std::mt19937_64 random(std::random_device{}());
  int hits = 0;
  for (int chain = 0; hits < n_wanted && !testing::Test::HasFailure(); ++chain) {
    ASSERT_LT(chain, n_wanted);
    fs::remove_all("killed");
    hits += kill_and_resume("killed", n_per_chain, random);
    expect_same("killed", "whole");
  }
  std::printf("%d kills\n", hits);
}

TEST_F(Resume, AfterKillsAtAnyMomentNothingDiffers)
{
  kill_in_chains(20, 4);
}

TEST_F(Resume, SlowAfterTwoHundredKillsNothingDiffers)
{
  kill_in_chains(200, 4);
}

TEST_F(Resume, SignalsLeaveACheckpoint)
{
  const std::string never = " --set /output/checkpoint_interval=never ";
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const std::string run = "signal_" + std::to_string(signal);
    Process process("exec " + program + " run torn.json --set /time/duration=1e6 -o " + run +
                    never);
    ASSERT_TRUE(eventually([&] { return file_text(run + "/history.csv").size() > 20000; }));
    EXPECT_TRUE(newest_checkpoint(run).empty());
    process.send(signal);
    EXPECT_EQ(process.wait().code, 128 + signal);
    EXPECT_FALSE(newest_checkpoint(run).empty());
    EXPECT_EQ(file_json(run + "/run.json")["status"], "interrupted");
  }
  make_half("half", "whole", never, 1);
  const Outcome outcome = run_ligament("resume half --json");
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_EQ(outcome.json()["status"], "done");
  expect_same("half", "whole");
}

TEST_F(Resume, AnEndOfTheWallTimeLeavesACheckpoint)
{
  const std::string longer = " --set /time/duration=1e6 --set /output/field_interval=never ";
  const auto outcome = run_ligament("run torn.json --wall-time 1 --json -o short" + longer);
  EXPECT_EQ(outcome.code, 124) << outcome.errors;
  EXPECT_EQ(outcome.json()["status"], "interrupted");
  EXPECT_TRUE(has(outcome.json()["reason"], "--wall-time at "));
  EXPECT_FALSE(newest_checkpoint("short").empty());
  const long steps = outcome.json()["steps"];
  const auto more = run_ligament("resume short --wall-time 0.8 --json");
  EXPECT_EQ(more.code, 124) << more.errors;
  EXPECT_GT(more.json()["steps"], steps);
}

TEST_F(Resume, PicturesForWhichNoTimeIsLeftAreDrawnLater)
{
  const auto outcome = run_ligament("run torn.json --wall-time 1e-3 --json -o late");
  EXPECT_EQ(outcome.code, 124) << outcome.errors;
  EXPECT_FALSE(newest_checkpoint("late").empty());
  EXPECT_TRUE(fs::is_empty("late/pictures"));
  EXPECT_TRUE(has(outcome.errors, "`ligament report late --field stress_yy`")) << outcome.errors;
  EXPECT_EQ(run_ligament("report late --field stress_yy -o drawn").code, 3); // of such a run
  EXPECT_TRUE(fs::exists("drawn/pictures/end_stress_yy.png"));
}

/// The same damage as in tests/unit/output/checkpoints_test.cc, which has all of it.
TEST_F(Resume, ADamagedCheckpointIsPassedOver)
{
  make_half("half");
  const auto damage = [](const std::string &file, const std::string &older, int kind) {
    std::string content = file_text(file);
    if (kind == 0)
      content[content.size() / 2] = char(content[content.size() / 2] ^ 4);
    else if (kind == 1)
      content.resize(content.size() / 3);
    else if (kind == 2)
      content.clear();
    else if (kind == 3)
      content = file_text(older);
    fs::remove(file);
    if (kind < 4)
      std::ofstream(file, std::ios::binary) << content;
  };
  for (const auto &[name, kinds] : {std::pair("body.bin", std::vector<int>{0, 1, 2, 3, 4}),
                                    std::pair("run.bin", std::vector<int>{0}),
                                    std::pair("manifest.json", std::vector<int>{0, 4})})
    for (const int kind : kinds) {
      fs::remove_all("damaged");
      fs::copy("half", "damaged", fs::copy_options::recursive);
      const std::string newest = newest_checkpoint("damaged");
      fs::path older = newest;
      for (const auto &entry : fs::directory_iterator("damaged/checkpoints"))
        if (entry.is_directory() && entry.path() != newest)
          older = entry.path();
      damage(newest + "/" + name, older / name, kind);
      const Outcome outcome = run_ligament("resume damaged");
      EXPECT_EQ(outcome.code, 0) << outcome.errors;
      EXPECT_TRUE(has(outcome.errors, "warning: a checkpoint cannot be used: "));
      EXPECT_TRUE(has(outcome.errors, newest + "/" + name)) << outcome.errors;
      expect_same("damaged", "whole");
    }
}

TEST_F(Resume, AnotherSceneIsRefused)
{
  make_half("half");
  const auto before = file_text("half/history.csv");
  const auto outcome = run_ligament("resume half --json --set /material/density=2 "
                                    "--set /loads/1/ramp=90 --set /output/magnification=3");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.json()["status"], "wrong input");
  EXPECT_TRUE(has(outcome.errors, "/material/density: 2.0, was 1.0")) << outcome.errors;
  EXPECT_TRUE(has(outcome.errors, "/loads/1/ramp: 90.0, was 100.0")) << outcome.errors;
  EXPECT_FALSE(has(outcome.errors, "/output/magnification")) << outcome.errors;
  EXPECT_TRUE(has(run_ligament("resume half --set /time/duration=300").errors,
                  "/time/duration: 300.0, was 400.0"));
  EXPECT_EQ(run_ligament("resume half --set /time/duratoin=500").code, 2);
  std::ofstream("other.json") << std::string(torn).replace(torn.find("0.22"), 4, "0.30");
  EXPECT_TRUE(
      has(run_ligament("resume half --scene other.json").errors, "/material/poissons_ratio"));
  EXPECT_EQ(file_text("half/history.csv"), before); // nothing was touched
  EXPECT_EQ(run_ligament("resume half --scene torn.json --set /output/checkpoint_interval=1").code,
            0);
  expect_same("half", "whole");
}

TEST_F(Resume, FoldersWithoutCheckpointAreRefused)
{
  EXPECT_TRUE(
      has(run_ligament("resume nothing").errors, "nothing is not the output folder of a run"));
  ASSERT_EQ(run_ligament("run torn.json --set /time/duration=5 -o none "
                         "--set /output/checkpoint_interval=never")
                .code,
            0);
  const auto outcome = run_ligament("resume none");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(has(outcome.errors, "no checkpoint to go on from")) << outcome.errors;
  EXPECT_EQ(file_json("none/run.json")["status"], "done");
}

TEST_F(Resume, ARunThatIsUnderWayIsLeftAlone)
{
  Process process("exec " + program + " run torn.json -o busy --set /time/duration=1e6",
                  "busy_run");
  ASSERT_TRUE(eventually([] { return !newest_checkpoint("busy").empty(); }));
  const auto outcome = run_ligament("resume busy");
  EXPECT_EQ(outcome.code, 4);
  EXPECT_TRUE(has(outcome.errors, "is under way in this folder")) << outcome.errors;
}

TEST_F(Resume, ARunCanBeProlonged)
{
  ASSERT_EQ(run_ligament("run torn.json --set /time/duration=200 -o first").code, 0);
  const auto nothing = run_ligament("resume first");
  EXPECT_EQ(nothing.code, 2);
  EXPECT_TRUE(has(nothing.errors, "the run has come to its end")) << nothing.errors;
  const auto outcome = run_ligament("resume first --set /time/duration=400");
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  expect_same("first", "whole");
}

// As a SIGKILL before the next checkpoint leaves it.
TEST_F(Resume, AProlongedRunThatIsKilledKeepsItsNewEnd)
{
  ASSERT_EQ(run_ligament("run torn.json --set /time/duration=200 -o prolonged").code, 0);
  const auto change = [](const std::string &file, const auto &edit) {
    auto json = file_json(file);
    edit(json);
    std::ofstream(file) << json.dump(2);
  };
  change("prolonged/scene.resolved.json", [](auto &scene) { scene["time"]["duration"] = 400.; });
  change("prolonged/run.json", [](auto &record) { record["status"] = "running"; });
  const auto outcome = run_ligament("resume prolonged");
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  expect_same("prolonged", "whole");
}

// The ball spins, the stamp does not.
TEST_F(Resume, ToolsAreKeptAsTheyHaveTurned)
{
  const auto states = file_json("whole/run.json")["states"];
  ASSERT_GE(states.size(), 2u);
  for (const auto &state : states) {
    ASSERT_EQ(state["tools"].size(), 2u);
    EXPECT_EQ(state["tools"][0]["turn"].size(), 12u);
    EXPECT_FALSE(state["tools"][1].contains("turn"));
  }
  EXPECT_NE(states.front()["tools"][0]["turn"], states.back()["tools"][0]["turn"]);
}

// Also where the first part of the run wrote none, and where it wrote more.
TEST_F(Resume, WhatIsWrittenMayChange)
{
  const auto fields_of = [](const std::string &run) {
    int n = 0;
    for (const auto &entry : fs::directory_iterator(run + "/fields"))
      n += entry.path().filename().string().rfind("particles_0", 0) == 0;
    return n;
  };
  const std::string first = "run torn.json --set /time/duration=100 -o written";
  ASSERT_EQ(run_ligament(first + " --set /output/field_interval=never").code, 0);
  EXPECT_EQ(fields_of("written"), 1);
  ASSERT_EQ(run_ligament("resume written --set /time/duration=200 --set /output/field_interval=30 "
                         "--set /output/history_interval=50")
                .code,
            0);
  EXPECT_EQ(fields_of("written"), 1 + 3);
  const auto rows = [] {
    const std::string text = file_text("written/history.csv");
    return std::count(text.begin(), text.end(), '\n');
  };
  const auto before = rows();
  ASSERT_EQ(run_ligament("resume written --set /time/duration=250 --set "
                         "/output/field_interval=never --set /output/history_interval=1")
                .code,
            0);
  EXPECT_EQ(fields_of("written"), 1 + 3);
  EXPECT_GE(rows(), before + 45);
}

// The speed of a crack is a mean over a time that the first part of the run chose.
TEST_F(Resume, TheDefaultSmoothingIsThatOfTheFirstStart)
{
  const std::string open = " --set /gauges/6/smoothing=0 ";
  ASSERT_EQ(run_ligament("run torn.json -o smooth --set /gauges/6/smoothing=2.5").code, 0);
  ASSERT_EQ(run_ligament("run torn.json --set /time/duration=125 -o longer" + open).code, 0);
  std::ofstream("open.json") << std::string(torn).replace(torn.find(", \"smoothing\": 20"), 17, "");
  const std::string scene = " --scene open.json ";
  for (const std::string duration : {"300", "400"}) {
    const auto outcome = run_ligament("resume longer" + (duration == "400" ? scene : "") +
                                      " --set /time/duration=" + duration);
    EXPECT_EQ(outcome.code, 0) << outcome.errors;
  }
  expect_same("longer", "smooth");
}

// Faces that were cut, touch and are bonded again: they are in the list of cut faces, not of bonds.
TEST_F(Resume, ARunWithRebondingGoesOnAsWell)
{
  const std::string pressed =
      R"( --set '/specimen/cracks=[{"points": [[-12, 0], [4, 0]]}]' )"
      R"( --set '/material/fracture/rebonding={"pressure": 1e-4, "strength": 2e-3}' )"
      "--set /loads/0/velocity/1=-2e-4 --set /loads/1/velocity/1=2e-4 --set '/tools=[]' "
      "--set '/gauges=[]' ";
  ASSERT_EQ(run_ligament("run torn.json -o bonded_whole" + pressed).code, 0);
  ASSERT_EQ(run_ligament("run torn.json --set /time/duration=200 -o bonded" + pressed).code, 0);
  const std::string rows = file_text("bonded/history.csv");
  const std::string names = rows.substr(0, rows.find('\n'));
  ASSERT_TRUE(has(names, ",rebonding"));
  const std::size_t last = rows.find_last_of('\n', rows.size() - 2);
  EXPECT_FALSE(has(rows.substr(last), ",0\n")) << "nothing was bonded again";
  const auto outcome = run_ligament("resume bonded --set /time/duration=400");
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  expect_same("bonded", "bonded_whole");
}

// A run that is to be longer loses nothing by what keeps it from going on.
TEST_F(Resume, ASetUpThatFailsLeavesTheRunAsItIs)
{
  const auto contents = [](const std::string &run) {
    std::map<std::string, std::string> files;
    for (const auto &entry : fs::recursive_directory_iterator(run))
      if (entry.is_regular_file() && entry.path().filename() != "run.log")
        files[entry.path()] = file_text(entry.path());
    return files;
  };
  const std::string bare = " --set '/tools=[]' --set '/gauges=[]' --set /time/duration=",
                    of_file = " --set /discrete_zone/packing=file --set "
                              "/discrete_zone/packing_file=cells.csv";
  ASSERT_EQ(
      run_ligament("run torn.json -o random --set /discrete_zone/packing=random" + bare + "1").code,
      0);
  fs::copy("random/packing.csv", "cells.csv", fs::copy_options::overwrite_existing);
  ASSERT_EQ(run_ligament("run torn.json -o uncut" + of_file + bare + "150").code, 0);
  ASSERT_EQ(run_ligament("run torn.json -o failing" + of_file + bare + "110").code, 0);
  fs::copy("failing", "kept", fs::copy_options::recursive);
  // Without what the set-up had found the particles are read again.
  std::ofstream("failing/packing.csv") << "x,y,r\nm,m,m\n0,0,none\n";
  std::ofstream("failing/checkpoints/reference.bin") << "nothing";
  const auto before = contents("failing");
  const auto outcome = run_ligament("resume failing --set /time/duration=150");
  EXPECT_EQ(outcome.code, 2) << outcome.errors;
  EXPECT_TRUE(contents("failing") == before);
  EXPECT_EQ(file_text("failing/run.log").rfind(file_text("kept/run.log"), 0), 0u);
  EXPECT_EQ(file_json("failing/run.json")["status"], "done");

  for (const char *file : {"/packing.csv", "/checkpoints/reference.bin"})
    std::ofstream(std::string("failing") + file, std::ios::binary)
        << file_text(std::string("kept") + file);
  const auto more = run_ligament("resume failing --set /time/duration=150");
  EXPECT_EQ(more.code, 0) << more.errors;
  expect_same("failing", "uncut");
  EXPECT_EQ(file_json("failing/scene.resolved.json")["time"]["duration"], 150);
  const std::string log = file_text("failing/run.log"), end = " done after ";
  EXPECT_TRUE(has(log, "goes on from checkpoint"));
  EXPECT_EQ(log.find(end), log.rfind(end)) << "of the part that was taken off";
}

/// A run's packing.csv has the rows that were used, under other numbers.
TEST_F(Resume, RowsOfAFileThatAreLostAreNotGuessed)
{
  const std::string bare = " --set '/tools=[]' --set '/gauges=[]' --set /time/duration=",
                    of_file = " --set /discrete_zone/packing=file --set "
                              "/discrete_zone/packing_file=more.csv";
  ASSERT_EQ(
      run_ligament("run torn.json -o drawn --set /discrete_zone/packing=random" + bare + "1").code,
      0);
  const std::string drawn = file_text("drawn/packing.csv");
  const auto behind_units = drawn.find('\n', drawn.find('\n') + 1) + 1;
  std::ofstream("more.csv") << drawn.substr(0, behind_units) << "0,55,0,0.5,0\n"
                            << drawn.substr(behind_units);
  const Outcome run = run_ligament("run torn.json -o of_more" + of_file + bare + "20");
  ASSERT_EQ(run.code, 0) << run.errors;
  fs::copy("of_more/checkpoints/reference.bin", "reference.bin",
           fs::copy_options::overwrite_existing);
  std::ofstream("of_more/checkpoints/reference.bin") << "nothing";
  const std::string resume = "resume of_more --set /time/duration=21";
  const Outcome lost = run_ligament(resume);
  EXPECT_EQ(lost.code, 2) << lost.errors;
  EXPECT_TRUE(has(lost.errors, "which rows of the packing file")) << lost.errors;
  fs::copy("reference.bin", "of_more/checkpoints/reference.bin",
           fs::copy_options::overwrite_existing);
  EXPECT_EQ(run_ligament(resume).code, 0);
}

/// What bodies and loops may be made of, in overrides of the scene.
const std::vector<std::pair<std::string, std::string>> other_scenes = {
    {"random", " --set /discrete_zone/packing=random --set /discrete_zone/relaxation_sweeps=4 "},
    {"file", " --set /discrete_zone/packing=file --set /discrete_zone/packing_file=packing.csv "},
    {"damped", " --set /damping/kinetic=true --set /coupling/step_ratio=4 "},
    {"resting", " --set /time/rest_threshold=1e-5 --set /far_field=none --set /damping/local=0.2 "},
    {"mesh", " --set /discrete_zone=none --set '/specimen/cracks=[]' --set /damping/mass=1e-3 "
             "--set /time/duration=5000 --set '/gauges=[]' "},
    {"weighted", " --set /coupling/scheme=acceleration --set /coupling/step_ratio=1 "
                 "--set '/tools=[]' "},
    {"cube", " --set /dimension=3 --set '/specimen={\"size\": [10, 30, 10]}' --set /far_field=none "
             "--set '/discrete_zone={\"extent\": \"all\", \"packing\": \"fcc\", \"spacing\": 1}' "
             "--set '/loads=[{\"boundary\": \"top\", \"velocity\": [null, 2e-3, null]}, "
             "{\"boundary\": \"bottom\", \"velocity\": [null, -2e-3, null]}]' "
             "--set /time/duration=60 --set '/gauges=[]' --set '/tools=[]' "}};

TEST_F(Resume, SlowOtherScenesGoOnAsWell)
{
  for (const auto &[name, overrides] : other_scenes) {
    SCOPED_TRACE(name);
    const auto outcome = run_ligament("run torn.json -o " + name + "_whole" + overrides);
    ASSERT_EQ(outcome.code, 0) << outcome.errors;
    if (name == "random")
      fs::copy("random_whole/packing.csv", "packing.csv", fs::copy_options::overwrite_existing);
    if (name != "mesh") {
      EXPECT_GE(file_json(name + "_whole/run.json")["broken_bonds"], 5);
    }
    const std::string rebuilt = name + "_rebuilt";
    EXPECT_EQ(run_ligament("run torn.json --rebuild-interval 100 -o " + rebuilt + overrides).code,
              0);
    expect_same(rebuilt, name + "_whole");
    make_half(name, name + "_whole", overrides);
    fs::rename(name, "moved_" + name);   // nothing depends on the place
    const bool is_lost = name == "file"; // then the set-up seeks again
    if (is_lost)
      std::ofstream("moved_" + name + "/checkpoints/reference.bin") << "nothing";
    const Outcome more = run_ligament("resume moved_" + name);
    EXPECT_EQ(more.code, 0) << more.errors;
    EXPECT_EQ(has(more.errors, "warning: what the set-up had found is lost"), is_lost);
    expect_same("moved_" + name, name + "_whole");
  }
}

/// The disk below the checkpoints of a run, which begins to refuse at a call.
std::string faulty_disk(const std::string &run, const std::string &action, int call)
{
  return "FAULTY_DISK_FOLDER=" + fs::absolute(run + "/checkpoints").string() +
         " FAULTY_DISK_ACTION=" + action + " FAULTY_DISK_CALL=" + std::to_string(call) +
         " FAULTY_DISK_ERROR=" + std::to_string(ENOSPC) + " " + with_faulty_disk();
}

TEST_F(Resume, AFailedWriteIsAWarning)
{
  const auto outcome =
      run_ligament("run torn.json -o once --json", faulty_disk("once", "fail", 30));
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_TRUE(has(outcome.errors, "warning: a checkpoint could not be written: "));
  EXPECT_EQ(outcome.json()["warnings"].size(), file_json("whole/run.json")["warnings"].size() + 1);
}

TEST_F(Resume, TheThirdFailureInARowEndsTheRun)
{
  const auto outcome =
      run_ligament("run torn.json -o full --json", faulty_disk("full", "fail_on", 30));
  EXPECT_EQ(outcome.code, 4);
  EXPECT_EQ(outcome.json()["status"], "failed");
  EXPECT_TRUE(has(outcome.errors, "3 checkpoints in a row could not be written: "))
      << outcome.errors;
  EXPECT_TRUE(has(outcome.errors, "No space left on device")) << outcome.errors;
  const Outcome more = run_ligament("resume full");
  EXPECT_EQ(more.code, 0) << more.errors;
  expect_same("full", "whole");
}
} // namespace
