// Every wrong command of tests/support/wrong_commands must end with its exit code and say what to
// do.
//
// A case is {"prepare": a line for sh in an empty folder, "command": the words behind `ligament`,
// perhaps with a redirection, "stdin": a text, "exit": code, "expect": parts of standard error,
// "json": false where no object is to be had}. $SCENES holds the valid scenes.
#include "tests/support/program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

using namespace ligament::tests;
namespace fs = std::filesystem;

namespace
{
const std::string support = LIGAMENT_SOURCE_DIR "/tests/support/";

std::vector<std::string> names_in(const std::string &folder)
{
  std::vector<std::string> names;
  for (const auto &entry : fs::directory_iterator(support + folder))
    names.push_back(entry.path().stem());
  std::sort(names.begin(), names.end());
  return names;
}

/// The command in a folder of its own.
Outcome start(const nlohmann::json &wrong, const std::string &name, const std::string &option)
{
  const fs::path home = fs::current_path();
  fs::remove_all("commands/" + name);
  fs::create_directories("commands/" + name);
  fs::current_path("commands/" + name);
  std::ofstream("stdin.txt") << wrong.value("stdin", "");
  const bool fed = wrong.contains("stdin");
  // Options stand before a redirection.
  std::string command = wrong["command"];
  const std::size_t redirection = std::min(command.find(" <"), command.find(" >"));
  command.insert(std::min(redirection, command.size()), option);
  const Outcome outcome =
      run_shell("export SCENES=" + support + "scenes; " + wrong.value("prepare", ":") + "\n" +
                LIGAMENT_PROGRAM " " + command + (fed ? " < stdin.txt" : ""));
  fs::current_path(home);
  return outcome;
}

class WrongCommand : public testing::TestWithParam<std::string>
{
};

class WrongSceneThroughTheProgram : public testing::TestWithParam<std::string>
{
};
} // namespace

TEST_P(WrongCommand, IsRefused)
{
  const auto wrong = file_json(support + "wrong_commands/" + GetParam() + ".json");
  ASSERT_TRUE(wrong.is_object());
  const Outcome outcome = start(wrong, GetParam(), wrong.value("json", true) ? " --json" : "");
  EXPECT_EQ(outcome.code, wrong["exit"]) << outcome.errors;
  for (const std::string part : wrong["expect"])
    EXPECT_NE(outcome.errors.find(part), std::string::npos) << part << "\n" << outcome.errors;
  if (!wrong.value("json", true))
    return;
  const auto json = outcome.json();
  ASSERT_TRUE(json.is_object()) << outcome.output;
  EXPECT_EQ(json["status"], outcome.code == 2 ? "wrong input" : "failed");
  ASSERT_TRUE(json.contains("errors"));
  EXPECT_GE(json["errors"].size(), 1u);
}

INSTANTIATE_TEST_SUITE_P(Corpus, WrongCommand, testing::ValuesIn(names_in("wrong_commands")),
                         [](const auto &info) { return info.param; });

// What tests/unit/scene/wrong_scenes_test.cc reads, with the exit code, and with key, place,
// message and remedy of each error for scripts.
TEST_P(WrongSceneThroughTheProgram, EndsWithTwoAndAnObject)
{
  const auto wrong = file_json(support + "wrong_scenes/" + GetParam() + ".json");
  std::string text = file_text(support + "scenes/" + wrong["base"].get<std::string>());
  for (const auto &change : wrong.value("replace", nlohmann::json::array())) {
    const std::string old = change[0];
    text.replace(text.find(old), old.size(), change[1].get<std::string>());
  }
  fs::create_directories("scenes");
  const std::string file = "scenes/" + GetParam() + ".json";
  std::ofstream(file) << text;
  std::string command = "exec " LIGAMENT_PROGRAM " check " + file + " --json";
  for (std::string set : wrong.value("set", std::vector<std::string>())) {
    for (std::size_t at = set.find('\''); at != set.npos; at = set.find('\'', at + 4))
      set.replace(at, 1, "'\\''");
    command += " --set '" + set + "'";
  }
  const Outcome outcome = run_shell(command);
  EXPECT_EQ(outcome.code, 2) << outcome.errors;
  const auto json = outcome.json();
  ASSERT_TRUE(json.is_object()) << outcome.output;
  EXPECT_EQ(json["status"], "wrong input");
  ASSERT_TRUE(json.contains("errors"));
  EXPECT_EQ(int(json["errors"].size()), wrong.value("errors", 1));
  for (const auto &error : json["errors"])
    for (const char *part : {"place", "message", "remedy"})
      EXPECT_FALSE(error[part].get<std::string>().empty()) << error.dump(2);
}

INSTANTIATE_TEST_SUITE_P(Corpus, WrongSceneThroughTheProgram,
                         testing::ValuesIn(names_in("wrong_scenes")),
                         [](const auto &info) { return info.param; });

// Killed again before its new end: what broke up to the earlier one is no result of this run.
TEST(ResumedRun, HasNoTablesOfItsEarlierEnd)
{
  const fs::path home = fs::current_path();
  fs::remove_all("resumed");
  fs::create_directory("resumed");
  fs::current_path("resumed");
  std::ofstream("bar.json") << R"({
    "dimension": 2,
    "specimen": {"size": [16, 40]},
    "material": {"youngs_modulus": 1, "poissons_ratio": 0.22, "density": 1},
    "discrete_zone": {"packing": "hexagonal", "spacing": 1},
    "far_field": "none",
    "loads": [{"boundary": "top", "velocity": [null, 1e-4], "ramp": 50}],
    "gauges": [{"name": "pieces", "kind": "fragments"}],
    "time": {"duration": 100},
    "output": {"checkpoint_interval": 1e-9, "history_interval": 1}
  })";
  const std::string ligament = "exec " LIGAMENT_PROGRAM " ";
  ASSERT_EQ(run_shell(ligament + "run bar.json -o out").code, 0);
  for (const char *table : {"broken_bonds.csv", "fragments.csv"})
    EXPECT_TRUE(fs::exists(std::string("out/") + table)) << table;
  const auto rows = fs::file_size("out/history.csv");
  {
    Process process(ligament + "resume out --set /time/duration=1e6", "resume");
    EXPECT_TRUE(eventually([&] { return fs::file_size("out/history.csv") > 2 * rows; }));
    process.send(SIGKILL);
    EXPECT_EQ(process.wait().code, 128 + SIGKILL);
  }
  EXPECT_EQ(file_json("out/run.json")["status"], "running");
  for (const char *table : {"broken_bonds.csv", "fragments.csv"})
    EXPECT_FALSE(fs::exists(std::string("out/") + table)) << table;
  const Outcome compared = run_shell(ligament + "compare out out");
  EXPECT_NE(compared.output.find("out has no broken_bonds.csv"), std::string::npos)
      << compared.output << compared.errors;
  fs::current_path(home);
}

TEST(WrongInputs, ThereAreMany)
{
  EXPECT_GE(names_in("wrong_commands").size() + names_in("wrong_scenes").size(), 350u);
}
