// The regime follows the motion of the body, and its changes are booked.
#include "src/simulation/energy_ledger.h"
#include "src/simulation/initial_motion.h"
#include "src/simulation/regime_control.h"
#include "tests/support/small_plate.h"

#include <Eigen/Geometry>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
/// A plate in the motion x = R S X at rest, and who watches it.
struct WatchedPlate
{
  SmallBody small;
  RegimeControl<2> control;
  coupling::StepTime step{0, 0, small.body.dt};

  WatchedPlate(RegimeChoice regime, double degrees, double strain,
               const std::vector<std::string> &kind = {}, bool is_warm = false)
      : small(small_scene(kind)), control(regime, small.body, is_warm)
  {
    const double angle = degrees * M_PI / 180;
    const Eigen::Matrix2d turn = Eigen::Rotation2Dd(angle).toRotationMatrix();
    small.deform(turn * Eigen::Vector2d(1, 1 + strain).asDiagonal() - Eigen::Matrix2d::Identity());
    if (small.body.zone)
      for (double &a : small.body.zone->state.rotation[0])
        a = angle;
    auto bodies = small.body.bodies();
    small.body.coupler->compute_forces(bodies, step);
  }

  std::optional<std::string> look() { return control.look(small.body, step, *small.log); }
  EnergyLedger ledger() const { return read_ledger(small.body, step, 0); }
};

TEST(RegimeControl, SmallRotationsStayLinear)
{
  WatchedPlate plate(RegimeChoice::automatic, 0.09, 1e-4);
  EXPECT_FALSE(plate.look());
  EXPECT_EQ(plate.control.history(), "linear");
  EXPECT_EQ(plate.small.body.regime_change, 0);
}

// A linear model would feel phi^2/2 until the first look.
TEST(RegimeControl, ABodyThatBeginsWithASpinIsNeverLinear)
{
  Scene scene = small_scene({R"(/initial_motion=[{"velocity": [1e-3, 0]}])"});
  EXPECT_FALSE(begins_with_spin(scene));
  scene = small_scene({R"(/initial_motion=[{"velocity": [1e-3, 0]}, {"spin": 1e-3}])"});
  EXPECT_TRUE(begins_with_spin(scene));
  SmallBody small(scene);
  const RegimeControl<2> control(RegimeChoice::automatic, small.body, false, true);
  EXPECT_EQ(control.history(), "corotated");
  const RegimeControl<2> fixed(RegimeChoice::linear, small.body, false, true);
  EXPECT_EQ(fixed.history(), "linear");
}

TEST(RegimeControl, ChangeOfRegimeIsBooked)
{
  for (const auto &kind : {body_kinds[0], body_kinds[2]}) { // those with a mesh
    SCOPED_TRACE(kind.name);
    WatchedPlate plate(RegimeChoice::automatic, 0.3, 0, kind.overrides);
    const EnergyLedger before = plate.ledger();
    EXPECT_FALSE(plate.look());
    EXPECT_EQ(plate.control.history(), "linear, corotated from 0 s");
    const EnergyLedger after = plate.ledger();
    // What the linear models felt of the rotation is gone from the body and stands in the ledger.
    const double felt = before.potential();
    EXPECT_GT(felt, 0);
    EXPECT_NEAR(after.residual() / before.residual(), 1, 1e-9);
    EXPECT_LT(std::abs(after.potential()), 1e-9 * felt);
    EXPECT_NEAR(after.regime_change / before.residual(), 1, 1e-9);
  }
}

TEST(RegimeControl, FiniteStrainBecomesNonlinear)
{
  WatchedPlate plate(RegimeChoice::automatic, 0, 0.02);
  EXPECT_FALSE(plate.look());
  EXPECT_EQ(plate.control.history(), "linear, nonlinear from 0 s");
}

// Between two equilibria lie as many steps as there may be: each of them is looked at.
TEST(RegimeControl, EquilibriaAreMeasuredInAnyStep)
{
  WatchedPlate plate(RegimeChoice::automatic, 0.3, 0);
  plate.step.step = 7 * plate.small.body.coupler->step_ratio();
  EXPECT_FALSE(plate.look());
  EXPECT_EQ(plate.control.history(), "linear");
  EXPECT_FALSE(plate.control.look(plate.small.body, plate.step, *plate.small.log, true));
  EXPECT_EQ(plate.control.history(), "linear, corotated from 0 s");
}

TEST(RegimeControl, RegimesAreNotTakenBack)
{
  WatchedPlate plate(RegimeChoice::automatic, 0.3, 0);
  EXPECT_FALSE(plate.look());
  plate.small.deform(Eigen::Matrix2d::Zero());
  EXPECT_FALSE(plate.look());
  EXPECT_EQ(plate.control.history(), "linear, corotated from 0 s");
}

// Pure bending by the curvature 2.5e-4: both ends of the overlap at 12 d from the axis turn by 0.17
// degrees against its middle, cells (4.1 d wide) by 0.14 at least; strains stay below 0.8 %.
TEST(RegimeControl, BendingBecomesNonlinear)
{
  WatchedPlate plate(RegimeChoice::automatic, 0, 0);
  auto &body = plate.small.body;
  constexpr double curvature = 2.5e-4;
  const auto bend = [&](Components<2> &u, int i, double x, double y) {
    u[0][i] = -curvature * x * y;
    u[1][i] = curvature * x * x / 2;
  };
  auto &state = body.zone->state;
  for (int i = 0; i < state.size(); ++i)
    bend(state.displacement, i, state.reference[0][i], state.reference[1][i]);
  for (int i = 0; i < body.far->mesh().n_nodes(); ++i) {
    const Vector<2> &x = body.far->mesh().nodes[i];
    bend(body.far->displacement, i, x[0], x[1]);
  }
  auto bodies = body.bodies();
  body.coupler->take_velocities(bodies);
  body.coupler->compute_forces(bodies, plate.step);
  EXPECT_FALSE(plate.look());
  EXPECT_EQ(plate.control.history(), "linear, nonlinear from 0 s");
}

TEST(RegimeControl, FixedRegimesAreKeptAndTheirLimitsReported)
{
  WatchedPlate linear(RegimeChoice::linear, 1, 0);
  const auto reason = linear.look();
  ASSERT_TRUE(reason);
  EXPECT_NE(reason->find("/coupling/regime"), std::string::npos) << *reason;
  EXPECT_FALSE(linear.look()) << "once is enough";
  EXPECT_EQ(linear.control.history(), "linear");

  WatchedPlate corotated(RegimeChoice::corotated, 90, 0);
  EXPECT_FALSE(corotated.look());
  EXPECT_EQ(corotated.control.history(), "corotated");

  WatchedPlate torn(RegimeChoice::nonlinear, 0, 0.12);
  EXPECT_TRUE(torn.look());
}

// Strains of 12 % to and fro every two critical steps of the mesh are no strain of 10 %; once they
// stay they are, when the mean has come to 10/12 of them: after ln 6 = 1.79 of its times, ten
// critical steps each.
TEST(RegimeControl, LimitsOfWarmBodiesAreThoseOfTheMeanMotion)
{
  WatchedPlate plate(RegimeChoice::nonlinear, 0, 0, {}, true);
  auto &body = plate.small.body;
  const double dt = plate.step.dt, mean_time = 10 * body.dt_far;
  const int ratio = body.coupler->step_ratio();
  const auto strained = [&](double strain) {
    plate.small.deform(Eigen::Vector2d(0, strain).asDiagonal());
    plate.step.step += ratio;
    return plate.look().has_value();
  };
  const long half_period = std::lround(2 * body.dt_far / (ratio * dt)),
             look_interval = 50 * ratio; // steps
  for (long k = 0; k < 2000; ++k)
    ASSERT_FALSE(strained(k / half_period % 2 == 0 ? 0.12 : -0.12)) << k;
  const long begin = plate.step.step;
  while (!strained(0.12))
    ASSERT_LT(double(plate.step.step - begin) * dt, 4 * mean_time);
  // The mean of before is at most 0.12 tanh(1/10), and looks are 50 steps of the mesh apart.
  const double expected = mean_time * std::log(6.),
               late = mean_time * std::tanh(0.1) + double(look_interval) * dt;
  EXPECT_NEAR(double(plate.step.step - begin) * dt, expected, late);

  // A run that is taken up again goes on with the same mean.
  core::State state;
  plate.control.save(state);
  RegimeControl<2> again(RegimeChoice::nonlinear, body, true);
  again.load(state, body);
  core::State same;
  again.save(same);
  EXPECT_EQ(state.at("mean_motion"), same.at("mean_motion"));
}
} // namespace
