// What may go wrong around a run: two of them in one folder, signals, full disks, folders that may
// not be written, inputs through pipes. The program must say so, keep what it computed, and end
// with the right code.
#include "tests/support/program.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include <sys/mount.h>
#include <sys/stat.h>

using namespace ligament::tests;
namespace fs = std::filesystem;

namespace
{
const std::string program = LIGAMENT_PROGRAM;

// A glass plate that is pulled; 0.1 ms is about 450 steps.
const std::string glass = R"({
  "title": "glass",
  "dimension": 2,
  "specimen": {"size": ["24 mm", "120 mm"]},
  "material": {"youngs_modulus": "72 GPa", "poissons_ratio": 0.22, "density": 2450},
  "discrete_zone": {
    "region": {"lower": [null, "-20 mm"], "upper": [null, "20 mm"]},
    "packing": "hexagonal", "spacing": "1 mm"
  },
  "far_field": {"cell_size": "4.1 mm"},
  "coupling": {"overlap_cells": 2, "transition_cells": 3},
  "loads": [{"boundary": "top", "velocity": [null, "0.01 m/s"], "ramp": "10 us"}],
  "time": {"duration": "0.05 ms"},
  "output": {"history_interval": "0.2 us", "progress_interval": 1000}
})";

const std::string endless = " --set '/time/duration=1 s' ";

/// Each test works in a folder of its own.
class Faults : public testing::Test
{
protected:
  void SetUp() override
  {
    home_ = fs::current_path();
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(name);
    fs::create_directory(name);
    fs::current_path(name);
    std::ofstream("scene.json") << glass;
  }
  void TearDown() override { fs::current_path(home_); }

  static Outcome ligament(const std::string &arguments)
  {
    return run_shell("exec " + program + " " + arguments);
  }
  /// Waits until the loop runs: rows of the history are on the disk.
  static bool runs(const std::string &folder)
  {
    return eventually([&] { return file_text(folder + "/history.csv").size() > 4000; });
  }
  static std::string status(const std::string &folder)
  {
    const auto json = file_json(folder + "/run.json");
    return json.is_object() ? json.value("status", "") : "no record";
  }

private:
  fs::path home_;
};

bool has(const std::string &text, const std::string &part)
{
  return text.find(part) != std::string::npos;
}

/// Whole rows below names and units.
bool is_whole_table(const std::string &text)
{
  std::istringstream lines(text);
  std::string line;
  std::size_t n_commas = 0, n_rows = 0;
  while (std::getline(lines, line)) {
    const std::size_t n = std::count(line.begin(), line.end(), ',');
    if (n_rows++ > 0 && n != n_commas)
      return false;
    n_commas = n;
  }
  return n_rows > 2 && text.back() == '\n';
}

/// A disk of its own, as far as the system lets us make one.
class SmallDisk
{
public:
  SmallDisk(const std::string &place, const std::string &size) : place_(place)
  {
    fs::create_directory(place);
    mounted_ = mount("none", place.c_str(), "tmpfs", 0, ("size=" + size).c_str()) == 0;
  }
  ~SmallDisk()
  {
    if (mounted_)
      umount(place_.c_str());
  }
  bool is_there() const { return mounted_; }

private:
  std::string place_;
  bool mounted_;
};
} // namespace

TEST_F(Faults, ASecondRunIntoAFolderInUseIsRefused)
{
  Process first("exec " + program + " run scene.json -o out" + endless, "first");
  ASSERT_TRUE(runs("out"));
  const auto second = ligament("run scene.json -o out --json");
  EXPECT_EQ(second.code, 4);
  EXPECT_TRUE(has(second.errors, "another run is under way in this folder (process "))
      << second.errors;
  EXPECT_EQ(second.json()["status"], "failed");
  EXPECT_FALSE(fs::exists("out.1"));
  // The lock ends with its process, however that ends.
  first.send(SIGKILL);
  EXPECT_EQ(first.wait().code, 128 + SIGKILL);
  const auto third = ligament("run scene.json -o out/");
  EXPECT_EQ(third.code, 0) << third.errors;
  EXPECT_EQ(status("out.1"), "running");
  EXPECT_EQ(status("out"), "done");
  EXPECT_FALSE(fs::exists("out/lock"));
  EXPECT_FALSE(fs::exists("out/run.json.reserve"));
}

TEST_F(Faults, SignalsCloseTheOutputs)
{
  for (const auto &[signal, name] :
       {std::pair(SIGINT, "SIGINT"), std::pair(SIGTERM, "SIGTERM"), std::pair(SIGHUP, "SIGHUP")})
  {
    const std::string folder = name;
    Process run("exec " + program + " run scene.json --json -o " + folder + endless);
    ASSERT_TRUE(runs(folder));
    run.send(signal);
    const Outcome outcome = run.wait();
    EXPECT_EQ(outcome.code, 128 + signal) << outcome.errors;
    EXPECT_EQ(outcome.json()["status"], "interrupted");
    EXPECT_EQ(status(folder), "interrupted");
    const auto record = file_json(folder + "/run.json");
    EXPECT_TRUE(has(record["reason"], name)) << record["reason"];
    EXPECT_GT(record["steps"], 0);
    EXPECT_FALSE(record["energy_residual"].is_null());
    EXPECT_TRUE(is_whole_table(file_text(folder + "/history.csv")));
    for (const char *file : {"broken_bonds.csv", "report.html", "pictures/end_stress_yy.png"})
      EXPECT_TRUE(fs::exists(folder + "/" + file)) << file;
  }
}

// A pipe that nobody fills holds the set-up up.
TEST_F(Faults, SignalsEndASetUpAtOnce)
{
  ASSERT_EQ(mkfifo("packing.csv", 0600), 0);
  Process run("exec " + program + " run scene.json -o out --set /discrete_zone/packing=file " +
              "--set /discrete_zone/packing_file=packing.csv --json");
  ASSERT_TRUE(eventually([] { return fs::exists("out/scene.resolved.json"); }));
  run.send(SIGTERM);
  const auto end = run.wait();
  EXPECT_EQ(end.code, 128 + SIGTERM);
  EXPECT_EQ(status("out"), "interrupted");
  EXPECT_EQ(end.json()["status"], "interrupted");
  EXPECT_FALSE(fs::exists("out/run.json.reserve"));
}

// Under nohup SIGHUP is ignored, and stays so.
TEST_F(Faults, IgnoredSignalsStayIgnored)
{
  Process run("trap '' HUP; exec " + program + " run scene.json -o out" + endless);
  ASSERT_TRUE(runs("out"));
  run.send(SIGHUP);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(status("out"), "running");
  run.send(SIGTERM);
  EXPECT_EQ(run.wait().code, 128 + SIGTERM);
}

TEST_F(Faults, AFullDiskFailsTheRunAndKeepsItsResults)
{
  int n_failed = 0, n_with_steps = 0;
  for (const char *size : {"8k", "100k", "160k", "260k", "600k"}) {
    SCOPED_TRACE(size);
    const SmallDisk disk("disk", size);
    if (!disk.is_there())
      GTEST_SKIP() << "no right to mount a disk";
    const auto outcome =
        ligament("run scene.json -o disk/out --json --set '/output/field_interval=10 us'");
    EXPECT_EQ(outcome.code, 4) << outcome.errors;
    EXPECT_EQ(outcome.json()["status"], "failed") << outcome.output << outcome.errors;
    EXPECT_TRUE(has(outcome.output + outcome.errors, "No space left on device")) << outcome.errors;
    if (!fs::exists("disk/out/run.json"))
      continue;
    ++n_failed;
    const auto record = file_json("disk/out/run.json");
    EXPECT_EQ(record["status"], "failed") << record.dump(2);
    EXPECT_TRUE(has(record["reason"], "No space left on device")) << record["reason"];
    if (record["steps"] > 0) {
      ++n_with_steps;
      EXPECT_FALSE(record["energy_residual"].is_null());
      EXPECT_TRUE(is_whole_table(file_text("disk/out/history.csv")));
    }
  }
  EXPECT_GE(n_failed, 3);
  EXPECT_GE(n_with_steps, 1);
}

// The same without rights: no file may grow beyond 16 kB. The history does.
TEST_F(Faults, ALimitOnFilesFailsTheRunAndKeepsItsResults)
{
  const auto outcome = run_shell("ulimit -f 32; exec " + program + " run scene.json -o out --json");
  EXPECT_EQ(outcome.code, 4) << outcome.errors;
  EXPECT_EQ(outcome.json()["status"], "failed");
  const auto record = file_json("out/run.json");
  EXPECT_EQ(record["status"], "failed");
  EXPECT_TRUE(has(record["reason"], "history.csv")) << record["reason"];
  EXPECT_TRUE(is_whole_table(file_text("out/history.csv")));
}

TEST_F(Faults, APictureLessIsAWarning)
{
  fs::create_directories("out/pictures/end_stress_yy.png/in_the_way");
  const auto outcome = ligament("run scene.json -o out --json");
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_EQ(outcome.json()["status"], "done");
  EXPECT_TRUE(has(outcome.errors, "warning: a picture is missing: ")) << outcome.errors;
  EXPECT_TRUE(fs::exists("out/report.html"));
}

TEST_F(Faults, AFolderThatIsNoRunIsRefused)
{
  fs::create_directory("home");
  std::ofstream("home/letter.txt") << "dear";
  std::ofstream("file") << "x";
  for (const char *place : {"home", "file", "."})
    for (const char *command : {"run scene.json", "sweep study.json"}) {
      std::ofstream("study.json") << R"({"scene": "scene.json", "rows": [{"name": "a"}]})";
      const auto outcome = ligament(std::string(command) + " --json -o " + place);
      EXPECT_EQ(outcome.code, 2) << command << " " << place;
      EXPECT_EQ(outcome.json()["status"], "wrong input");
      EXPECT_TRUE(has(outcome.errors, "--output")) << outcome.errors;
    }
  EXPECT_EQ(std::distance(fs::directory_iterator("home"), {}), 1);
  EXPECT_EQ(file_text("file"), "x");
}

// A run that was refused before its first step does not push its forerunner's results aside for
// good, and a new one takes its place.
TEST_F(Faults, ARunThatIsRefusedLateSaysWhyAndMakesWay)
{
  const auto outcome = ligament("run scene.json -o out --json --set /coupling/step_ratio=64");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(status("out"), "failed");
  EXPECT_TRUE(has(file_json("out/run.json")["reason"], "/coupling/step_ratio"));
  EXPECT_EQ(ligament("run scene.json -o out").code, 0);
  EXPECT_FALSE(fs::exists("out.1"));
}

// A run that was ended from outside its loop does not know how many steps it took: its rows do.
TEST_F(Faults, ARunThatFailedBehindItsFirstRowsIsKept)
{
  ASSERT_EQ(ligament("run scene.json -o out").code, 0);
  auto record = file_json("out/run.json");
  record["status"] = "failed";
  record["steps"] = 0;
  std::ofstream("out/run.json") << record.dump();
  const std::string table = file_text("out/history.csv");
  EXPECT_EQ(ligament("run scene.json -o out").code, 0);
  ASSERT_TRUE(fs::exists("out.1"));
  EXPECT_EQ(file_text("out.1/history.csv"), table);
}

TEST_F(Faults, TornTablesAreReadInUnfinishedRuns)
{
  ASSERT_EQ(ligament("run scene.json -o out").code, 0);
  std::string table = file_text("out/history.csv");
  std::ofstream("out/history.csv") << table.substr(0, table.size() - 10);
  EXPECT_EQ(ligament("report out").code, 2) << "a finished run has a whole table";
  auto record = file_json("out/run.json");
  for (const char *state : {"running", "interrupted", "failed"}) {
    record["status"] = state;
    std::ofstream("out/run.json") << record.dump();
    const auto report = ligament("report out");
    EXPECT_TRUE(report.code == 0 || report.code == 3) << report.errors;
    const auto compared = ligament("compare out out");
    EXPECT_TRUE(compared.code == 0 || compared.code == 3) << compared.errors;
  }
}

TEST_F(Faults, ScenesComeThroughPipes)
{
  const auto expect_built = [](const Outcome &outcome) {
    EXPECT_EQ(outcome.code, 0) << outcome.errors;
    EXPECT_GT(outcome.json().value("particles", 0), 500) << outcome.output;
  };
  expect_built(run_shell(program + " check - --json < scene.json"));
  expect_built(run_shell("cat scene.json | " + program + " check - --json"));
  ASSERT_EQ(mkfifo("pipe", 0600), 0);
  expect_built(run_shell("cat scene.json > pipe & " + program + " check pipe --json"));
  const auto late =
      run_shell(program + " check - --json --set /coupling/step_ratio=64 < scene.json");
  EXPECT_EQ(late.code, 2);
  EXPECT_EQ(late.json()["errors"][0]["key"], "/coupling/step_ratio");
  const auto early = run_shell("echo '{\"dimension\": 4}' | " + program + " check -");
  EXPECT_EQ(early.code, 2);
  EXPECT_TRUE(has(early.errors, "standard input:1:15: error: ")) << early.errors;
  ASSERT_EQ(run_shell(program + " run - < scene.json").code, 0);
  EXPECT_EQ(status("ligament-out"), "done");
}

// Whatever the name of the user: a folder lies where the file would be.
TEST_F(Faults, CompareAndReportWhereNothingMayBeWritten)
{
  ASSERT_EQ(ligament("run scene.json -o out").code, 0);
  fs::create_directories("out/compare_out.svg/in_the_way");
  const auto compared = ligament("compare out out --json");
  EXPECT_EQ(compared.code, 0) << compared.errors;
  EXPECT_TRUE(has(compared.output, "particles")) << compared.output;
  EXPECT_TRUE(has(compared.errors, "--output")) << compared.errors;
  EXPECT_EQ(compared.json()["plot"], "");
  const auto elsewhere = ligament("compare out out --json -o new/place");
  EXPECT_EQ(elsewhere.code, 0) << elsewhere.errors;
  EXPECT_TRUE(fs::is_regular_file("new/place/compare_out.html"));

  fs::remove("out/report.html");
  fs::create_directories("out/report.html/in_the_way");
  const auto report = ligament("report out --json");
  EXPECT_EQ(report.code, 4);
  EXPECT_EQ(report.json()["status"], "failed");
  EXPECT_TRUE(has(report.errors, "--output")) << report.errors;
  EXPECT_EQ(ligament("report out -o new").code, 0);
  EXPECT_TRUE(fs::is_regular_file("new/report.html"));
}

TEST_F(Faults, StreamsThatTakeNothing)
{
  EXPECT_EQ(run_shell("exec " + program + " explain > /dev/full").code, 4);
  const auto full = run_shell("exec " + program + " run scene.json -o out --json > /dev/full");
  EXPECT_EQ(full.code, 4);
  EXPECT_TRUE(has(full.errors, "standard output")) << full.errors;
  EXPECT_EQ(status("out"), "done");
  EXPECT_EQ(run_shell("exec " + program +
                      " run scene.json -o mute --set /output/progress_interval=1e-3 2> /dev/full")
                .code,
            0);
  EXPECT_EQ(run_shell("exec " + program + " check nothing.json 2> /dev/full").code, 2);
}

TEST_F(Faults, LateErrorsArePlacedLikeAllOthers)
{
  std::ofstream("sparse.csv") << "x,y,r\nmm,mm,mm\n0,0,0.5\n1,0,0.5\n0,1,0.5\n1,1,0.5\n";
  std::ofstream("bad.csv") << "\xEF\xBB\xBFx,y,r\nmm,mm,mm\n0,zero,0.5\n";
  const std::string file = "--set /discrete_zone/packing=file --set /discrete_zone/packing_file=";
  const struct
  {
    std::string set, key, message;
  } cases[] = {
      {"--set /coupling/step_ratio=64", "/coupling/step_ratio", "far field's stable step"},
      {"--set '/time/step=1 us'", "/time/step", "of the stable step"},
      {"--set '/far_field/cell_size=2.6 mm'", "/coupling/overlap_cells", "close the packing"},
      {file + "missing.csv", "/discrete_zone/packing_file", "No such file"},
      {file + "bad.csv", "/discrete_zone/packing_file", "bad.csv:3: "},
      {file + "sparse.csv", "/discrete_zone/packing_file", "do not fill the discrete zone"},
      {"--set '/loads=[{\"boundary\": \"left\", \"velocity\": [0, null]}]' --set "
       "'/discrete_zone/region/upper=[null, null]'",
       "/loads/0/boundary", "the overlap ends at the side"}};
  for (const auto &c : cases) {
    const auto outcome = ligament("check scene.json --json " + c.set);
    EXPECT_EQ(outcome.code, 2) << c.set;
    const auto errors = outcome.json()["errors"];
    ASSERT_EQ(errors.size(), 1u) << outcome.output << outcome.errors;
    EXPECT_EQ(errors[0]["key"], c.key);
    EXPECT_TRUE(has(errors[0].dump(), c.message)) << errors[0].dump(2);
    EXPECT_FALSE(errors[0]["remedy"].get<std::string>().empty()) << errors[0].dump(2);
    EXPECT_FALSE(errors[0]["place"].get<std::string>().empty());
  }
  // In the file: line and column of the key.
  std::string text = glass;
  text.replace(text.find("\"transition_cells\""), 0, "\n    \"step_ratio\": 64, ");
  std::ofstream("late.json") << text;
  const auto error = ligament("check late.json --json").json()["errors"][0];
  EXPECT_EQ(error["line"], 12);
  EXPECT_EQ(error["column"], 5);
}

// The file of a zone, given to the pure discrete twin, would leave most of the specimen to a few
// large cells.
TEST_F(Faults, APackingOfTheZoneIsNoneOfTheSpecimen)
{
  ASSERT_EQ(ligament("run scene.json -o random --set /discrete_zone/packing=random").code, 0);
  const std::string file =
      " --set /discrete_zone/packing=file --set /discrete_zone/packing_file=random/packing.csv";
  EXPECT_EQ(ligament("check scene.json" + file).code, 0);
  const auto twin = ligament("check scene.json --json --set /far_field=none" + file);
  EXPECT_EQ(twin.code, 2);
  EXPECT_EQ(twin.json()["errors"][0]["key"], "/discrete_zone/packing_file");
  EXPECT_TRUE(has(twin.errors, "twin needs the packing of the whole specimen")) << twin.errors;
}

TEST_F(Faults, LargeScenesAreCheckedByVolumes)
{
  const auto start = std::chrono::steady_clock::now();
  const std::string large = "check scene.json --json --set '/specimen/size=[\"2.4 m\", \"12 m\"]' "
                            "--set '/discrete_zone/region/lower=[null, \"-2 m\"]' "
                            "--set '/discrete_zone/region/upper=[null, \"2 m\"]'";
  const auto outcome = ligament(large);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_LT(seconds.count(), 5) << "about a second, most of it to load the solver";
  const auto json = outcome.json();
  // 2.4 m x 4 m in cells of sqrt(3)/2 mm^2.
  EXPECT_NEAR(json["particles"].get<double>(), 9.6 / (std::sqrt(0.75) * 1e-6), 2e5);
  EXPECT_NEAR(json["overlap_particles"].get<double>(), 2 * 2.4 * 8.2e-3 / (std::sqrt(0.75) * 1e-6),
              3e3);
  for (const char *name : {"dt", "dt_critical", "steps", "predicted_seconds", "predicted_saving"})
    EXPECT_TRUE(json[name].is_null()) << name;
  EXPECT_EQ(json["built"], false);
  EXPECT_GE(json["not_checked"].size(), 4u);
  EXPECT_GT(json["available_memory_bytes"], 0);
  EXPECT_GT(json["memory_bytes"], 1e9);
  EXPECT_TRUE(has(outcome.output, "--full")) << outcome.output;
}

TEST_F(Faults, ManyLoadsAreRefusedSoon)
{
  std::string loads;
  for (int k = 0; k < 2000; ++k)
    loads +=
        std::string(k == 0 ? "" : ", ") + R"({"boundary": "top", "traction": [null, "1 MPa"]})";
  std::string text = glass;
  const std::size_t at = text.find("[{\"boundary\""), end = text.find('\n', at);
  std::ofstream("many.json") << text.replace(at, end - at, "[" + loads + "],");
  const auto start = std::chrono::steady_clock::now();
  const auto outcome = ligament("check many.json --json");
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.json()["errors"].size(), 1999u);
  EXPECT_LT(seconds.count(), 2);
}
