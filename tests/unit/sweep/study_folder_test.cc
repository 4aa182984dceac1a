// Which runs of a study count as finished: by their scene and their end, never by their names.
#include "src/sweep/study_folder.h"

#include "core/check.h"
#include "core/files.h"
#include "src/output/run_record.h"
#include "src/sweep/cases.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

using namespace ligament;
using namespace ligament::program;

namespace
{
void write_run(const std::string &folder, const std::string &scene, const std::string &status)
{
  const RunFolder run{folder};
  run.create();
  core::write_file(run.resolved_scene(), scene);
  RunRecord record;
  record.status = status;
  write_run_record(run.record(), record);
}

std::string fresh(const std::string &folder)
{
  std::filesystem::remove_all(folder);
  return folder;
}

std::string text(const char *scene)
{
  return scene_text(nlohmann::ordered_json::parse(scene));
}

TEST(StudyFolder, FindsRunsByTheirScene)
{
  const std::string path = fresh("found");
  write_run(path + "/runs/any_name", R"({"b": 2, "title": "x", "a": 1})", "done");
  write_run(path + "/runs/stopped", R"({"a": 2})", "stopped");
  const StudyFolder folder(path);
  // The order of the keys and the title mean nothing.
  ASSERT_TRUE(folder.finished(text(R"({"a": 1, "b": 2, "title": "y"})")));
  EXPECT_EQ(folder.finished(text(R"({"a": 1, "b": 2})"))->path, path + "/runs/any_name");
  EXPECT_TRUE(folder.finished(text(R"({"a": 2})")));
  EXPECT_FALSE(folder.finished(text(R"({"a": 1})")));
  EXPECT_FALSE(folder.finished(text(R"({"a": 1, "b": 2.5})")));
}

// A scene names its packing, not what is in it.
TEST(StudyFolder, ChangedFilesMakeRunsOld)
{
  namespace fs = std::filesystem;
  const std::string path = fresh("changed");
  core::write_file("seeds.csv", "x");
  const std::string scene = R"({"discrete_zone": {"packing_file": "seeds.csv"}})";
  write_run(path + "/runs/one", scene, "done");
  const auto begun = fs::last_write_time(path + "/runs/one/scene.resolved.json");
  fs::last_write_time("seeds.csv", begun - std::chrono::seconds(5));
  EXPECT_TRUE(StudyFolder(path).finished(text(scene.c_str())));
  fs::last_write_time("seeds.csv", begun + std::chrono::seconds(5));
  EXPECT_FALSE(StudyFolder(path).finished(text(scene.c_str())));
  fs::remove("seeds.csv");
  EXPECT_TRUE(StudyFolder(path).finished(text(scene.c_str())));
}

TEST(StudyFolder, UnfinishedAndDamagedRunsDoNotCount)
{
  const std::string path = fresh("unfinished");
  write_run(path + "/runs/killed", R"({"a": 1})", "running");
  write_run(path + "/runs/failed", R"({"a": 2})", "failed");
  write_run(path + "/runs/damaged", R"({"a": 3)", "done");
  write_run(path + "/runs/half", R"({"a": 4})", "done");
  core::write_file(path + "/runs/half/run.json", "{\"status\": \"do");
  write_run(path + "/runs/no_scene", R"({"a": 5})", "done");
  std::filesystem::remove(path + "/runs/no_scene/scene.resolved.json");
  std::filesystem::create_directories(path + "/runs/empty");
  EXPECT_TRUE(finished_runs(path).empty());
}

TEST(StudyFolder, TwoSweepsDoNotShareIt)
{
  const std::string path = fresh("locked");
  {
    const StudyFolder first(path);
    EXPECT_THROW(StudyFolder{path}, core::EnvironmentError);
  }
  EXPECT_NO_THROW(StudyFolder{path});
}

TEST(StudyFolder, CostsComeBack)
{
  const RunFolder run{fresh("cost")};
  run.create();
  EXPECT_FALSE(read_cost(run));
  write_cost(run, {1.25, 3e8, 2});
  EXPECT_EQ(read_cost(run)->core_seconds, 1.25);
  EXPECT_EQ(read_cost(run)->peak_memory, 3e8);
  EXPECT_EQ(read_cost(run)->jobs, 2);
}
} // namespace
