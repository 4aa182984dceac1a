// A stretch of a static phase ends where the kinematics of the overlap change on its way.
#include "src/simulation/regime_control.h"
#include "src/simulation/static_phases.h"
#include "src/simulation/static_stretch.h"
#include "tests/support/static_body.h"

#include <cmath>
#include <optional>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
/// A plate whose top is drawn sideways by a fiftieth of its height: the overlap turns by more than
/// a tenth of a degree, where the linear regime ends, on the way.
struct ShearedPlate : StaticBody<2>
{
  static std::vector<std::string> overrides()
  {
    return {R"(/loads=[{"boundary": "top", "displacement": [2.4, 0], "ramp": 1000},
                       {"boundary": "bottom", "displacement": [0, 0]}])",
            "/time/loading=static"};
  }

  RegimeControl<2> regime{RegimeChoice::automatic, body};
  Clock clock;
  int n_looks = 0, n_after_change = 0;

  ShearedPlate() : StaticBody(overrides())
  {
    clock.now = {0, 0, body.dt};
    const int ratio = body.coupler->step_ratio();
    clock.n_steps = long(1000 / body.dt) / ratio * ratio;
  }

  std::optional<Stop> look()
  {
    ++n_looks;
    n_after_change += body.regime_change != 0;
    EXPECT_FALSE(regime.look(body, clock.now, log, true));
    return {};
  }
};

TEST(StaticStretch, EndsWhereTheOverlapChangesItsKinematics)
{
  ShearedPlate plate;
  StaticStretch<2> stretch(plate.body, plate.solver, plate.clock, plate.clock.n_steps);
  using End = StaticStretch<2>::End;
  ASSERT_EQ(stretch.find_response(), End::converged);
  ASSERT_EQ(stretch.find_end(), End::converged);
  ASSERT_EQ(stretch.n_steps(), plate.clock.n_steps);
  const auto commit = [&](const Eigen::VectorXd &) { plate.system().forces(plate.clock.now.time); };
  EXPECT_FALSE(stretch.walk(plate.clock, commit, [&] { return plate.look(); }));
  EXPECT_GT(plate.n_looks, 2);
  ASSERT_NE(plate.body.regime_change, 0);
  EXPECT_EQ(plate.n_after_change, 0) << "the rest of the way was another body's";
  EXPECT_LT(plate.clock.now.step, plate.clock.n_steps);
}

TEST(StaticStretch, PhaseEndsInEquilibriumOfTheChangedKinematics)
{
  ShearedPlate plate;
  StaticPhases<2> phases(static_scene<2>(ShearedPlate::overrides()), plate.body, plate.log);
  EXPECT_FALSE(phases.advance(plate.body, plate.clock, 0, [&] { return plate.look(); }));
  ASSERT_TRUE(plate.clock.is_at_end());
  ASSERT_GT(plate.n_after_change, 0);
  const Eigen::VectorXd left = plate.system().forces(plate.clock.now.time);
  const double load = plate.system().load_force(plate.clock.now.time);
  std::printf("out of balance %.2e of the load\n", left.lpNorm<Eigen::Infinity>() / load);
  constexpr double near = 1e-6; // to which a phase that goes on is balanced, static_phases.cc
  EXPECT_LT(left.lpNorm<Eigen::Infinity>(), near * load);
}

// A slender body whose end is drawn aside by a sixth of its length: equilibria lie off any
// parabola.
struct BentPlate : StaticBody<2>
{
  Clock clock;
  std::optional<StaticStretch<2>> stretch;

  BentPlate()
      : StaticBody({"/far_field=none", "/discrete_zone/extent=all",
                    R"(/loads=[{"boundary": "top", "displacement": [20, null], "ramp": 1000},
                               {"boundary": "bottom", "displacement": [0, 0]}])",
                    "/time/loading=static"})
  {
    clock.now = {0, 0, body.dt};
    clock.n_steps = long(1000 / body.dt);
    stretch.emplace(body, solver, clock, clock.n_steps);
    using End = StaticStretch<2>::End;
    EXPECT_EQ(stretch->find_response(), End::converged);
    EXPECT_EQ(stretch->find_end(), End::converged);
  }
};

TEST(StaticStretch, RowsOfLargeRotationsAreInBalance)
{
  BentPlate plate;
  int n_rows = 0;
  const auto commit = [&](const Eigen::VectorXd &) { plate.system().forces(plate.clock.now.time); };
  const auto look = [&]() -> std::optional<Stop> {
    ++n_rows;
    EXPECT_LT(plate.solver.imbalance(plate.clock.now.time), 1.01e-4) << plate.clock.now.time;
    return {};
  };
  EXPECT_FALSE(plate.stretch->walk(plate.clock, commit, look));
  EXPECT_GT(n_rows, 20);
}

// The end of the stretch is known to be in balance, whatever the solver makes of a row before it.
TEST(StaticStretch, RowsWithoutEquilibriumAreNoStatesOfTheBody)
{
  BentPlate plate;
  int n_rows = 0;
  double worst = 0;
  const auto commit = [&](const Eigen::VectorXd &velocities) {
    worst = std::max(worst, plate.solver.imbalance(plate.clock.now.time));
    if (++n_rows != 3)
      return;
    Eigen::VectorXd spoiled(velocities.size()); // far from any equilibrium
    for (Eigen::Index i = 0; i < spoiled.size(); ++i)
      spoiled[i] = 3 * std::sin(double(i * i));
    plate.system().displace(spoiled);
  };
  const auto look = []() -> std::optional<Stop> { return {}; };
  EXPECT_FALSE(plate.stretch->walk(plate.clock, commit, look));
  EXPECT_TRUE(plate.clock.is_at_end());
  EXPECT_EQ(n_rows, 4) << "the first three and the last";
  EXPECT_LT(worst, 1.01e-4);
}
} // namespace
