// Equilibria of bodies some of whose faces have begun to soften: their stiffness, and how they are
// found.
#include "core/extremes.h"
#include "src/simulation/damping.h"
#include "tests/support/static_body.h"

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
/// A plate with a notch, drawn apart until what is ahead of the notch softens.
struct SofteningPlate : StaticBody<2>
{
  static constexpr double ramp = 3000;

  explicit SofteningPlate(const std::vector<std::string> &overrides)
      : StaticBody(
            overrides +
            std::vector<std::string>{
                R"(/specimen/cracks=[{"points": [[-13, 0.3], [-4, 0.3]]}])",
                R"(/material/fracture={"criterion": "maximum_tension", "strength": 1e-3, "energy": 2e-4})",
                R"(/loads=[{"boundary": "top", "displacement": [0, 0.06], "ramp": 3000},
                                  {"boundary": "bottom", "displacement": [0, -0.06], "ramp": 3000}])"})
  {
    BodyDamping<2> damping({0, 0.03, false});
    auto bodies = body.bodies();
    coupling::StepTime now{0, 0, body.dt};
    body.coupler->compute_forces(bodies, now);
    for (; n_softening() < 12 && now.time < ramp; body.coupler->compute_forces(bodies, now)) {
      damping.before_kick(body, now);
      body.coupler->kick(bodies, now);
      damping.after_kick(body, now);
      body.coupler->drift(bodies, now);
      ++now.step;
      now.time = double(now.step) * body.dt;
      time = now.time;
    }
  }

  /// Faces of which something is left.
  int n_softening()
  {
    int n = 0;
    for (const auto &face : system().touching())
      n += face[2] == 2;
    return n;
  }

  double time = 0;
};

const std::vector<std::vector<std::string>> all_kinds = {
    {},
    {"/far_field=none", "/specimen/size=[24, 60]"},
    {"/far_field=none", "/specimen/size=[24, 60]", "/discrete_zone/packing=\"random\"",
     "/material/poissons_ratio=0.4"}};

// To first order it is that of faces that open further, or go back on their secants.
TEST(StaticSoftening, StiffnessIsWhatForcesChangeByAsTheLoadGrows)
{
  for (const auto &overrides : all_kinds) {
    SofteningPlate one(overrides);
    ASSERT_GE(one.n_softening(), 12);
    auto &system = one.system();
    Eigen::VectorXd moved, growth;
    ASSERT_EQ(one.solver.find_equilibrium(one.time, moved), EquilibriumSolver<2>::End::converged);
    ASSERT_EQ(one.solver.find_response(one.time, one.time + 1, growth),
              EquilibriumSolver<2>::End::converged);
    const Eigen::VectorXd at_rest = system.forces(one.time);
    system.linearise_here();
    const Eigen::VectorXd x = one.noise(1), y = one.noise(2);
    const Eigen::VectorXd kx = system.stiffness_times(x), ky = system.stiffness_times(y);
    EXPECT_NEAR(y.dot(kx), x.dot(ky), 1e-7 * x.norm() * ky.norm());

    // What opens further depends on the way: the motion must be near that of the load, which alone
    // leaves the body in balance.
    const Eigen::VectorXd way = growth + 1e-3 * growth.lpNorm<Eigen::Infinity>() * one.noise(3);
    const Eigen::VectorXd k_way = system.stiffness_times(way);
    constexpr double step = 1e-3;
    const auto start = system.place();
    system.displace(way, step);
    const Eigen::VectorXd change = (at_rest - system.forces(one.time)) / step;
    system.put_back(start);
    system.linearise_at_reference();
    const double difference = (change - k_way).norm() / change.norm(),
                 of_whole = (change - system.stiffness_times(way)).norm() / change.norm();
    std::printf("%d faces: difference %.2e of the change, %.2e if none had softened\n",
                one.n_softening(), difference, of_whole);
    // The stiffness holds the share of bending that is left, some hundredths of what falls.
    EXPECT_LT(difference, 0.03 * of_whole);
  }
}

TEST(StaticSoftening, NextEquilibriumIsFoundInAFewSolves)
{
  for (const auto &overrides : all_kinds) {
    SofteningPlate one(overrides);
    Eigen::VectorXd moved;
    ASSERT_EQ(one.solver.find_equilibrium(one.time, moved), EquilibriumSolver<2>::End::converged);
    const int first = one.solver.n_solves();
    ASSERT_EQ(one.solver.find_equilibrium(one.time * 1.001, moved),
              EquilibriumSolver<2>::End::converged);
    std::printf("%d solves, %d for the next\n", first, one.solver.n_solves() - first);
    EXPECT_LE(one.solver.n_solves() - first, 8);
  }
}

// A look at a state leaves no trace: the forces of the step are those before.
TEST(StaticSoftening, TrialsAreForgotten)
{
  SofteningPlate one(all_kinds[1]);
  const auto force = one.body.zone->state.force;
  const auto start = one.system().place();
  one.system().displace(one.noise(3), 1e-3);
  one.system().forces(one.time);
  one.system().put_back(start);
  auto bodies = one.body.bodies();
  one.body.coupler->compute_forces(bodies, {0, one.time, one.body.dt});
  double difference = 0;
  for (int c = 0; c < 2; ++c)
    for (std::size_t i = 0; i < force[c].size(); ++i)
      keep_largest(difference, std::abs(one.body.zone->state.force[c][i] - force[c][i]));
  EXPECT_LT(difference, 1e-12 * 1e-3); // of what a face bears
}
} // namespace
