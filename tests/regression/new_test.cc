// `ligament new`: every kind is written, checked without an error or a warning, and run.
#include "tests/support/program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

using namespace ligament::tests;
namespace fs = std::filesystem;

namespace
{
Outcome program(const std::string &words)
{
  return run_shell("exec " LIGAMENT_PROGRAM " " + words);
}

const std::string sources = LIGAMENT_SOURCE_DIR "/src/launcher/new/";

std::vector<std::string> kinds()
{
  std::vector<std::string> names;
  for (const auto &entry : fs::directory_iterator(sources))
    names.push_back(entry.path().stem());
  std::sort(names.begin(), names.end());
  return names;
}

std::string written(const std::string &kind)
{
  fs::remove(kind + ".json");
  EXPECT_EQ(program("new " + kind).code, 0);
  return kind + ".json";
}

class NewScene : public testing::TestWithParam<std::string>
{
};

class SlowNewScene : public testing::TestWithParam<std::string>
{
};
} // namespace

TEST_P(NewScene, IsWrittenAsItStands)
{
  EXPECT_EQ(file_text(written(GetParam())), file_text(sources + GetParam() + ".json"));
}

TEST_P(NewScene, ChecksWithoutWarnings)
{
  const Outcome outcome = program("check " + written(GetParam()) + " --json");
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_EQ(outcome.errors.find("warning"), std::string::npos) << outcome.errors;
  const auto json = outcome.json();
  ASSERT_TRUE(json.is_object()) << outcome.output;
  EXPECT_TRUE(json["errors"].empty());
  EXPECT_TRUE(json.value("warnings", nlohmann::json::array()).empty()) << json["warnings"];
}

// The whole run: to its end, and something breaks.
TEST_P(SlowNewScene, RunsToItsEnd)
{
  const std::string folder = GetParam() + "-run";
  fs::remove_all(folder);
  const Outcome outcome = program("run " + written(GetParam()) + " --output " + folder);
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  const auto record = file_json(folder + "/run.json");
  ASSERT_TRUE(record.is_object());
  EXPECT_EQ(record["status"], "done");
  const std::string faces = file_text(folder + "/broken_bonds.csv");
  EXPECT_GT(std::count(faces.begin(), faces.end(), '\n'), 10);
}

INSTANTIATE_TEST_SUITE_P(Kinds, NewScene, testing::ValuesIn(kinds()),
                         [](const auto &info) { return info.param; });
INSTANTIATE_TEST_SUITE_P(Kinds, SlowNewScene, testing::ValuesIn(kinds()),
                         [](const auto &info) { return info.param; });

TEST(NewCommand, ListsAllKindsWithALine)
{
  const auto listed = program("new --json").json()["kinds"];
  std::vector<std::string> names;
  for (const auto &kind : listed) {
    names.push_back(kind["kind"]);
    const std::string summary = kind["summary"];
    EXPECT_GT(summary.size(), 20u);
    EXPECT_LE(summary.size(), 80u) << summary;
    for (const char *words : {"new", "new --help"})
      EXPECT_NE(program(words).output.find(summary), std::string::npos) << words;
  }
  EXPECT_EQ(names, kinds());
}

TEST(NewCommand, DoesNotWriteOverAFile)
{
  std::ofstream("mine.json") << "mine";
  const Outcome outcome = program("new spall --output mine.json");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.errors.find("mine.json exists"), std::string::npos) << outcome.errors;
  EXPECT_EQ(file_text("mine.json"), "mine");
}

TEST(NewCommand, WritesWhereItIsTold)
{
  fs::remove("other.json");
  const Outcome outcome = program("new spall -o other.json --json");
  EXPECT_EQ(outcome.json()["scene"], "other.json");
  const std::string text = file_text(sources + "spall.json");
  EXPECT_EQ(file_text("other.json"), text);
  EXPECT_EQ(program("new spall -o -").output, text);
}
