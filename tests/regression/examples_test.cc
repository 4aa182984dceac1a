// What the examples promise: all of them can be computed, and the main one shows what its README
// says.
#include "tests/support/program.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

using namespace ligament::tests;

namespace
{
const std::string examples = LIGAMENT_SOURCE_DIR "/examples";

Outcome run_ligament(const std::string &arguments)
{
  return run_shell("exec " LIGAMENT_PROGRAM " " + arguments);
}

TEST(Examples, AllCheck)
{
  int n_scenes = 0, n_studies = 0;
  for (const auto &folder : std::filesystem::directory_iterator(examples)) {
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "README.md")) << folder;
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "picture.png")) << folder;
    int n = 0;
    for (const auto &file : std::filesystem::directory_iterator(folder)) {
      if (file.path().extension() != ".json")
        continue;
      SCOPED_TRACE(file.path());
      ++n;
      const bool is_study = file_text(file.path()).find("\"scene\":") != std::string::npos;
      ++(is_study ? n_studies : n_scenes);
      const Outcome outcome =
          is_study ? run_ligament("sweep " + file.path().string() + " --dry-run --json -o dry_" +
                                  std::to_string(n_studies))
                   : run_ligament("check " + file.path().string() + " --json");
      EXPECT_EQ(outcome.code, 0) << outcome.errors;
      if (!is_study) {
        EXPECT_TRUE(outcome.json()["errors"].empty()) << outcome.last_line();
      }
    }
    EXPECT_GE(n, 1) << folder;
  }
  EXPECT_GE(n_scenes, 32);
  EXPECT_GE(n_studies, 5);
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
