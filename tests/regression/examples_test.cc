// What the examples promise: all of them can be computed, and the main one shows what its README
// says.
#include "src/scene/read_scene.h"
#include "tests/support/program.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <vector>

using namespace ligament::tests;

namespace
{
const std::string examples = LIGAMENT_SOURCE_DIR "/examples";

Outcome run_ligament(const std::string &arguments)
{
  return run_shell("exec " LIGAMENT_PROGRAM " " + arguments);
}

/// All that run by themselves; of studies each case is checked.
std::vector<std::filesystem::path> scenes()
{
  std::vector<std::filesystem::path> found;
  for (const auto &folder : std::filesystem::directory_iterator(examples))
    for (const auto &file : std::filesystem::directory_iterator(folder))
      if (file.path().extension() == ".json" &&
          file_text(file.path()).find("\"scene\":") == std::string::npos)
        found.push_back(file.path());
  return found;
}

TEST(Examples, EachIsExplainedAndReadsWithoutErrors)
{
  int n_folders = 0;
  for (const auto &folder : std::filesystem::directory_iterator(examples)) {
    ++n_folders;
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "README.md")) << folder;
    if (std::filesystem::exists(folder.path() / "scene.json")) {
      EXPECT_TRUE(std::filesystem::exists(folder.path() / "picture.png")) << folder;
    }
  }
  EXPECT_GE(n_folders, 32);
  EXPECT_GE(scenes().size(), std::size_t(n_folders));
  for (const auto &scene : scenes()) {
    const auto read = ligament::program::read_scene(scene.string());
    for (const auto &error : read.errors)
      ADD_FAILURE() << scene << ": " << ligament::core::to_string(error);
  }
}

// Four minutes: each body is made; of a temperature the crystal is run.
TEST(Examples, SlowAllCheck)
{
  for (const auto &scene : scenes()) {
    SCOPED_TRACE(scene);
    const Outcome outcome = run_ligament("check " + scene.string() + " --json");
    EXPECT_EQ(outcome.code, 0) << outcome.errors;
    EXPECT_TRUE(outcome.json()["errors"].empty()) << outcome.last_line();
  }
}

/// The plate breaks at the load of Tada's strip, crack across the whole width, and as its pure
/// discrete twin does.
TEST(Examples, TheMainOneBreaksAsItsToughnessSays)
{
  const std::string scene = examples + "/cracked_plate/scene.json";
  const Outcome coupled = run_ligament("run " + scene + " -o coupled --json");
  ASSERT_EQ(coupled.code, 0) << coupled.errors;
  const auto record = file_json("coupled/run.json");
  EXPECT_EQ(record["status"], "done");
  EXPECT_TRUE(std::filesystem::exists("coupled/report.html"));

  const double pi = std::acos(-1.), width = 80e-3, a = 10e-3, spacing = 0.5e-3,
               stress = 0.75e6 / std::sqrt(pi * a / std::cos(pi * a / width));
  EXPECT_NEAR(record["peak_stress"].get<double>() / stress, 1, 0.05);
  EXPECT_NEAR(record["crack_length"].get<double>(), width - 2 * a, 2 * spacing);
  EXPECT_LT(record["energy_residual"].get<double>(), 1e-4);

  const Outcome pure = run_ligament("run " + scene + " -o pure --set /far_field=none");
  ASSERT_EQ(pure.code, 0) << pure.errors;
  const Outcome compared = run_ligament("compare coupled pure --json");
  EXPECT_EQ(compared.code, 0) << compared.errors;
  const auto difference = compared.json();
  EXPECT_LT(std::abs(difference["peak_load_error"].get<double>()), 5e-3);
  EXPECT_LT(std::abs(difference["stiffness_error"].get<double>()), 1e-3);
  EXPECT_LT(difference["crack_distance_max"].get<double>(), 0.01);
  const auto twin = file_json("pure/run.json");
  EXPECT_EQ(record["broken_bonds"], twin["broken_bonds"]);
  EXPECT_GT(twin["particles"].get<double>() / record["particles"].get<double>(), 10);
}
} // namespace
