// What follows the motion of a body, in three dimensions: the regime, and damping.
#include "core/extremes.h"
#include "src/simulation/damping.h"
#include "src/simulation/energy_ledger.h"
#include "src/simulation/initial_motion.h"
#include "src/simulation/regime_control.h"
#include "tests/support/small_bar.h"

#include <Eigen/Geometry>

#include <cmath>
#include <random>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
const std::vector<BodyKind> kinds_with_mesh = {body_kinds[0], body_kinds[2]};

Eigen::Vector3d random_axis(unsigned seed)
{
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  return Eigen::Vector3d::NullaryExpr([&] { return normal(random); }).normalized();
}

/// A bar in the motion x = R S X at rest, R about an axis at random, and who watches it.
struct WatchedBar
{
  Bar bar;
  RegimeControl<3> control;

  WatchedBar(unsigned seed, double degrees, double strain, const std::vector<std::string> &kind)
      : bar(kind), control(RegimeChoice::automatic, bar.body)
  {
    const Eigen::AngleAxisd turn(degrees * M_PI / 180, random_axis(seed));
    if (bar.body.zone) {
      const Eigen::Quaterniond q(turn);
      auto &rotation = bar.body.zone->state.rotation;
      for (int i = 0; i < bar.body.zone->state.size(); ++i)
        for (int c = 0; c < 4; ++c)
          rotation[c][i] = c == 0 ? q.w() : q.vec()[c - 1];
    }
    const Eigen::Matrix3d stretch = Eigen::Vector3d(1, 1 + strain, 1).asDiagonal();
    bar.deform(turn.toRotationMatrix() * stretch - Eigen::Matrix3d::Identity());
  }

  std::string look()
  {
    EXPECT_FALSE(control.look(bar.body, {0, 0, bar.body.dt}, bar.log));
    return control.history();
  }
  EnergyLedger ledger() const { return read_ledger(bar.body, {0, 0, bar.body.dt}, 0); }
};

TEST(RegimeOfABar, FollowsTurnsAboutAnyAxisAndStrains)
{
  for (const auto &kind : kinds_with_mesh)
    for (unsigned seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE(kind.name + (" " + std::to_string(seed)));
      EXPECT_EQ(WatchedBar(seed, 0.09, 1e-4, kind.overrides).look(), "linear");
      if (kind.overrides.empty()) { // of a mesh alone strains up to 10 % are taken as they are
        EXPECT_EQ(WatchedBar(seed, 0, 0.02, {}).look(), "linear, nonlinear from 0 s");
      }

      WatchedBar turned(seed, 0.3, 0, kind.overrides);
      const EnergyLedger before = turned.ledger();
      EXPECT_EQ(turned.look(), "linear, corotated from 0 s");
      const EnergyLedger after = turned.ledger();
      EXPECT_GT(before.potential(), 0);
      EXPECT_LT(std::abs(after.potential()), 1e-8 * before.potential());
      EXPECT_NEAR(after.residual() / before.residual(), 1, 1e-8);
    }
}

TEST(RegimeOfABar, IsCorotatedFromTheStartWhereItSpins)
{
  for (const std::string spin : {"[1e-3, 0, 0]", "[0, 1e-3, 0]", "[0, 0, -1e-3]"}) {
    const Scene scene = static_scene<3>({"/initial_motion=[{\"spin\": " + spin + "}]"});
    EXPECT_TRUE(begins_with_spin(scene)) << spin;
  }
  EXPECT_FALSE(
      begins_with_spin(static_scene<3>({R"(/initial_motion=[{"velocity": [1e-3, 0, 0]}])"})));
}

/// Energies after a release from a state at rest, over that state's.
struct Release
{
  double error = 0, left = 0, taken = 0;
};

Release release(const std::vector<std::string> &overrides, double duration)
{
  const Scene scene = static_scene<3>(overrides);
  Bar bar(overrides);
  auto &body = bar.body;
  const Eigen::Vector3d axis = random_axis(4);
  bar.deform(1e-6 * (axis * Eigen::RowVector3d(0, 1, 0)));
  BodyDamping<3> damping(scene.damping);
  auto bodies = body.bodies();
  coupling::StepTime step{0, 0, body.dt};
  const EnergyLedger start = read_ledger(body, step, 0);
  Release result;
  while (step.time < duration) {
    damping.before_kick(body, step);
    body.coupler->kick(bodies, step);
    damping.after_kick(body, step);
    body.coupler->drift(bodies, step);
    ++step.step;
    step.time = double(step.step) * step.dt;
    body.coupler->compute_forces(bodies, step);
    const EnergyLedger now = read_ledger(body, step, damping.energy());
    keep_largest(result.error, std::abs(now.residual() - start.residual()) / start.potential());
    result.left = (now.kinetic() + now.potential()) / start.potential();
    result.taken = now.damping / start.potential();
  }
  return result;
}

// 60 long, wave speed about 1: stretched and sheared along the bar, and let go. Particles that turn
// have rotations at rest in the sheared state, which differ from those of the body: free vibrations
// of single cells, damped as all else.
TEST(DampingOfABar, TakesWhatItBooks)
{
  constexpr double linear = 5e-6; // nonlinear terms of a strain of 1e-6 are of this order
  for (const auto &kind : body_kinds) {
    SCOPED_TRACE(kind.name);
    const auto undamped = kind.overrides + std::vector<std::string>{"/coupling/fine_damper=0",
                                                                    "/coupling/gap_filter=0"};
    const Release free = release(undamped, 60);
    EXPECT_LT(free.error, linear);
    EXPECT_NEAR(free.left, 1, linear);
    EXPECT_EQ(free.taken, 0);
    for (const std::string damping :
         {"/damping/local=0.3", "/damping/mass=0.05", "/damping/kinetic=true"})
    {
      SCOPED_TRACE(damping);
      const Release damped = release(undamped + std::vector<std::string>{damping}, 60);
      EXPECT_LT(damped.error, linear);
      EXPECT_LT(damped.left, 0.5);
      EXPECT_NEAR(damped.left + damped.taken, 1, linear);
    }
  }
}
} // namespace
