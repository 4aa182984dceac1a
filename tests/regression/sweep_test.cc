// `ligament sweep` from outside: killed in the middle, resumed, in another order, refused cases.
#include "core/files.h"
#include "src/output/run_record.h"
#include "src/sweep/study_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <thread>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace ligament;
using namespace ligament::program;

namespace
{
const std::string scene = R"({
  "dimension": 2,
  "specimen": {"size": [16, 80]},
  "material": {"youngs_modulus": 1, "poissons_ratio": 0.22, "density": 1},
  "discrete_zone": {
    "region": {"lower": [null, -20], "upper": [null, 20]}, "packing": "hexagonal", "spacing": 1
  },
  "far_field": {"cell_size": 4.1},
  "coupling": {"overlap_cells": 2, "transition_cells": 3},
  "loads": [{"boundary": "top", "velocity": [null, 1e-4], "ramp": 50}],
  "time": {"duration": 1000}
})";

/// Four cases, one of them refused: an overlap of six cells does not fit into the zone.
std::string study(const std::string &cells)
{
  return R"({"scene": "scene.json", "reference": "pure DEM",
    "total": {"stiffness": 1.0508}, "measure": "stiffness",
    "grids": [{"vary": {"/coupling/overlap_cells": )" +
         cells + R"(}}],
    "rows": [{"name": "pure DEM", "rival": true, "set": {"/far_field": "none"}}]})";
}

/// Standard output goes to out.txt.
pid_t start_sweep()
{
  const pid_t id = fork();
  if (id == 0) {
    const int out = open("out.txt", O_WRONLY | O_CREAT | O_TRUNC, 0666);
    const int err = open("err.txt", O_WRONLY | O_CREAT | O_TRUNC, 0666);
    dup2(out, 1);
    dup2(err, 2);
    execl(LIGAMENT_PROGRAM, "ligament", "sweep", "study.json", "--output", "sweep", "--json",
          nullptr);
    _exit(127);
  }
  return id;
}

/// The JSON on the last line.
nlohmann::json finish_sweep(pid_t id, int code)
{
  int status = 0;
  waitpid(id, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), code) << core::read_file("err.txt");
  std::string text = core::read_file("out.txt");
  text.pop_back();
  return nlohmann::json::parse(text.substr(text.rfind('\n') + 1));
}

/// Folders below sweep/runs whose run has this status.
std::vector<std::string> runs(const std::string &status)
{
  std::vector<std::string> found;
  std::error_code none;
  for (const auto &entry : std::filesystem::directory_iterator("sweep/runs", none)) {
    const RunFolder run{entry.path()};
    if (run.holds_a_run() && read_run_record(run.record()).status == status)
      found.push_back(run.path);
  }
  return found;
}

bool wait_for(const std::function<bool()> &condition)
{
  for (int k = 0; k < 30000; ++k) {
    if (condition())
      return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

TEST(Sweep, OfStandardInputHasAFolderWithAName)
{
  core::write_file("scene.json", scene);
  core::write_file("study.json", study("[2]"));
  ASSERT_EQ(std::system(LIGAMENT_PROGRAM " sweep - --dry-run --json < study.json > out.txt"), 0);
  std::string text = core::read_file("out.txt");
  text.pop_back();
  const auto json = nlohmann::json::parse(text.substr(text.rfind('\n') + 1));
  EXPECT_EQ(json["output"], "ligament-sweep");
}

TEST(Sweep, SurvivesAKillAndComputesNothingTwice)
{
  std::filesystem::remove_all("sweep");
  core::write_file("scene.json", scene);
  core::write_file("study.json", study("[2, 3, 6]"));

  const pid_t killed = start_sweep();
  ASSERT_TRUE(wait_for([] { return !runs("done").empty() && runs("running").size() == 1; }));
  kill(killed, SIGKILL);
  waitpid(killed, nullptr, 0);
  const auto done = runs("done"), running = runs("running");
  ASSERT_GE(done.size(), 1u);
  ASSERT_EQ(running.size(), 1u);
  const std::string first = core::read_file(done[0] + "/run.json");

  const auto resumed = finish_sweep(start_sweep(), 0);
  EXPECT_EQ(resumed["status"], "done");
  EXPECT_EQ(resumed["cases"], 4);
  EXPECT_EQ(resumed["done"], 3);
  EXPECT_EQ(resumed["refused"], 1);
  EXPECT_EQ(resumed["reused"], done.size());
  EXPECT_EQ(core::read_file(done[0] + "/run.json"), first); // not written over
  EXPECT_EQ(runs("done").size(), 3u);
  EXPECT_EQ(runs("running"), std::vector<std::string>{running[0] + ".1"}); // kept, not counted

  // Another order, and a folder of another name: the scenes are the same.
  std::filesystem::rename(done[0], "sweep/runs/renamed");
  core::write_file("study.json", study("[6, 3, 2]"));
  const auto again = finish_sweep(start_sweep(), 0);
  EXPECT_EQ(again["reused"], 3);
  EXPECT_EQ(again["done"], 3);
  for (const char *file : {"sweep.csv", "sweep.html", "coupling_error.svg", "total_error.svg"})
    EXPECT_TRUE(std::filesystem::exists(std::string("sweep/") + file)) << file;
  const std::string table = core::read_file("sweep/sweep.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 2 + 4);
  EXPECT_NE(table.find("overlap_cells=6,overlap_cells,refused"), std::string::npos) << table;
}

// What the step is, only the built body says: the study itself is right.
TEST(Sweep, WithoutItsReferenceIsNotComplete)
{
  std::filesystem::remove_all("sweep");
  core::write_file("scene.json", scene);
  core::write_file("study.json", R"({"scene": "scene.json", "reference": "long step",
    "grids": [{"vary": {"/coupling/overlap_cells": [2]}}],
    "rows": [{"name": "long step", "set": {"/time/step": 100}}]})");
  const auto json = finish_sweep(start_sweep(), 3);
  EXPECT_EQ(json["status"], "stopped");
  EXPECT_EQ(json["complete"], false);
  EXPECT_EQ(json["done"], 1);
  EXPECT_EQ(json["refused"], 1);
  const std::string table = core::read_file("sweep/sweep.csv");
  EXPECT_NE(table.find("100 s is more than"), std::string::npos) << table;
}
} // namespace
