// The program as users start it: exit codes, what is printed where, and that it answers at once.
#include "core/version.h"
#include "tests/support/slowness.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <sys/wait.h>

namespace
{
const std::string program = LIGAMENT_PROGRAM;
const std::string wrong_study =
    LIGAMENT_SOURCE_DIR "/tests/support/wrong_studies/several_at_once.json";
const std::string plate = LIGAMENT_SOURCE_DIR "/tests/support/scenes/plate.json";

struct Outcome
{
  int code;
  std::string text; // standard output
  double seconds;
};

Outcome start(const std::string &arguments, const std::string &environment = "")
{
  const auto begin = std::chrono::steady_clock::now();
  Outcome outcome{};
  FILE *pipe =
      popen((environment + " " + program + " " + arguments + " 2> stderr.txt").c_str(), "r");
  std::array<char, 4096> buffer;
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
    outcome.text.append(buffer.data(), n);
  outcome.code = WEXITSTATUS(pclose(pipe));
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return outcome;
}

std::string errors()
{
  std::string text(std::filesystem::file_size("stderr.txt"), ' ');
  FILE *file = std::fopen("stderr.txt", "r");
  text.resize(std::fread(text.data(), 1, text.size(), file));
  std::fclose(file);
  return text;
}

bool has(const std::string &text, const std::string &part)
{
  return text.find(part) != std::string::npos;
}
} // namespace

TEST(Launcher, HelpVersionAndExplain)
{
  EXPECT_EQ(start("--help").code, 0);
  for (const char *command :
       {"run", "resume", "check", "compare", "sweep", "explain", "report", "verify"})
  {
    EXPECT_TRUE(has(start("--help").text, command));
    EXPECT_EQ(start(std::string(command) + " --help").code, 0);
  }
  const Outcome version = start("--version");
  EXPECT_EQ(version.code, 0);
  EXPECT_TRUE(has(version.text, ligament::core::version()));
  const Outcome explain = start("explain overlap_cells");
  EXPECT_EQ(explain.code, 0);
  EXPECT_TRUE(has(explain.text, "default  3"));
  const std::string study = start("explain --study --json").text;
  const auto last_line = study.rfind('\n', study.size() - 2) + 1; // npos + 1 is the beginning
  EXPECT_TRUE(nlohmann::json::parse(study.substr(last_line)).contains("properties")) << study;
}

TEST(Launcher, MistakesOnTheCommandLineAreWrongInput)
{
  EXPECT_EQ(start("").code, 2);
  EXPECT_EQ(start("fly").code, 2);
  EXPECT_EQ(start("run").code, 2);
  EXPECT_EQ(start("run a.json --sett /a=1").code, 2);
  EXPECT_EQ(start("explain raduis").code, 2);
  EXPECT_TRUE(has(errors(), "did you mean \"radius\"?"));
  EXPECT_EQ(start("explain overlap_cells --markdown").code, 2);
  EXPECT_EQ(start("new -o scene.json").code, 2);
  EXPECT_TRUE(has(start("run --json").text, "{\"status\":\"wrong input\",\"errors\":[{"));
}

TEST(Launcher, WrongScenesArePrintedWithAllErrors)
{
  const std::string wrong = " " + plate + " --set /coupling/overlap_cells=1 --set /time/duration=0";
  for (const std::string command : {"run", "check"}) {
    const Outcome outcome = start(command + wrong + " --json");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_TRUE(has(errors(), "--set /coupling/overlap_cells: error: ")) << errors();
    EXPECT_TRUE(has(errors(), "--set /time/duration: error: ")) << errors();
    const std::size_t last_line = outcome.text.rfind('\n', outcome.text.size() - 2) + 1;
    EXPECT_TRUE(has(outcome.text.substr(last_line), "\"errors\":[{")) << outcome.text;
  }
}

TEST(Launcher, WrongStudiesArePrintedWithAllErrors)
{
  const Outcome outcome = start("sweep " + wrong_study + " --json");
  EXPECT_EQ(outcome.code, 2);
  for (const char *place : {":4:3: error: ", ":5:26: error: ", ":6:14: error: "})
    EXPECT_TRUE(has(errors(), place)) << errors();
  EXPECT_TRUE(has(outcome.text, "\"errors\":[{")) << outcome.text;
  EXPECT_EQ(start("sweep no_such_study.json").code, 2);
  EXPECT_EQ(start("sweep " + wrong_study + " --jobs 0").code, 2);
}

TEST(Launcher, SeveralRanksRefuseWhatOneProcessMustCompute)
{
  for (const std::string command : {"run ", "check "}) {
    EXPECT_EQ(start(command + plate +
                    " --set /coupling/scheme=acceleration --set /coupling/step_ratio=1 -n 2")
                  .code,
              2);
    EXPECT_TRUE(has(errors(), "an energy-weighted scheme on several ranks")) << errors();
  }
  EXPECT_EQ(start("run " + plate + " -n 0").code, 2);
}

// The copy stands in a folder without a solver.
TEST(Launcher, MissingSolverIsAMatterOfTheEnvironment)
{
  std::filesystem::copy_file(program, "ligament_alone",
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_EQ(WEXITSTATUS(std::system(("./ligament_alone run " + plate + " 2> stderr.txt").c_str())),
            4);
  EXPECT_TRUE(has(errors(), "ligament-solver"));
  EXPECT_EQ(
      WEXITSTATUS(std::system(("./ligament_alone run " + plate + " -n 2 2> stderr.txt").c_str())),
      4);
  EXPECT_TRUE(has(errors(), "scripts/build.sh ligament-solver")) << errors();
  EXPECT_EQ(WEXITSTATUS(std::system("./ligament_alone verify patch 2> stderr.txt")), 4);
  EXPECT_TRUE(has(errors(), "scripts/build.sh ligament-verify")) << errors();
}

// A tenth of a second is what people feel as at once; deal.II alone takes five times that to load.
TEST(Launcher, AnswersAtOnce)
{
  for (const std::string &arguments :
       {std::string("--help"), std::string("explain"), "run " + plate + " --set /dimension=4",
        "sweep " + wrong_study + " --json"})
  {
    double fastest = start(arguments).seconds;
    for (int k = 1; k < 5; ++k)
      fastest = std::min(fastest, start(arguments).seconds);
    EXPECT_LT(fastest, 0.1 * ligament::tests::slowness) << arguments;
  }
}
