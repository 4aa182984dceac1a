// Loading by equilibria: what the keys choose, and which scenes may have it.
#include "core/files.h"
#include "src/scene/read_scene.h"

#include <gtest/gtest.h>

using namespace ligament;
using namespace ligament::program;

namespace
{
/// A scene of tests/support.
ReadResult read(const std::string &name, const std::vector<std::string> &overrides)
{
  return parse_scene(core::read_file(LIGAMENT_SOURCE_DIR "/tests/support/scenes/" + name), name,
                     overrides);
}

ReadResult plate(const std::vector<std::string> &overrides)
{
  return read("plate.json", overrides);
}

std::string messages(const std::vector<core::Diagnostic> &diagnostics)
{
  std::string text;
  for (const core::Diagnostic &d : diagnostics)
    text += core::to_string(d) + "\n";
  return text;
}

/// Warnings beside those of the plate itself.
std::string doubts(const std::vector<std::string> &overrides)
{
  const ReadResult result = plate(overrides);
  EXPECT_TRUE(result.scene) << messages(result.errors);
  const std::string all = messages(result.warnings), own = messages(plate({}).warnings);
  EXPECT_EQ(all.substr(0, own.size()), own);
  return all.substr(own.size());
}

const std::string loading = "/time/loading=static";

TEST(Phases, WordsChoose)
{
  const ReadResult without = plate({});
  ASSERT_TRUE(without.scene);
  EXPECT_EQ(without.scene->time.loading, Loading::dynamic);
  EXPECT_FALSE(without.scene->time.has_phases());
  EXPECT_EQ(without.scene->time.calm, 8);
  EXPECT_EQ(without.scene->time.static_solver, StaticSolver::automatic);

  const ReadResult with =
      plate({"/time/loading=sequential", "/time/calm=4", "/time/static_solver=multigrid"});
  ASSERT_TRUE(with.scene);
  EXPECT_EQ(with.scene->time.loading, Loading::sequential);
  EXPECT_TRUE(with.scene->time.has_phases());
  EXPECT_EQ(with.scene->time.calm, 4);
  EXPECT_EQ(with.scene->time.static_solver, StaticSolver::multigrid);
  EXPECT_EQ(plate({loading}).scene->time.loading, Loading::quasi_static);
}

// A plate that is damped, pulled and held asks for nothing more.
TEST(Phases, SoundScenesAreNotDoubted)
{
  EXPECT_EQ(doubts({loading}), "");
  EXPECT_EQ(doubts({"/time/loading=sequential", "/damping/local=0"}), "") << "it has no waves";
  for (const std::string damping : {"/damping/mass=100", "/damping/kinetic=true"})
    EXPECT_EQ(doubts({loading, "/damping/local=0", damping}), "") << damping;
  const std::string absorbing = R"(/loads=[
    {"boundary": "top", "traction": [null, 1e6], "ramp": 1e-4, "absorbing": true},
    {"boundary": "bottom", "displacement": [null, 0]}])";
  EXPECT_EQ(doubts({loading, "/damping/local=0", "/far_field/levels=0", absorbing}), "");
}

// Steps that an equilibrium skips cost nothing: a laboratory's hour is refused only without them.
TEST(Phases, MayLastMoreStepsThanAMachineCanDo)
{
  const std::vector<std::string> hour = {"/time/duration=3600 s", "/time/step=1e-10 s"}; // 3.6e13
  const ReadResult with = read("bar.json", {hour[0], hour[1], loading});
  EXPECT_TRUE(with.scene) << messages(with.errors);
  EXPECT_FALSE(read("bar.json", hour).scene);
}
} // namespace
