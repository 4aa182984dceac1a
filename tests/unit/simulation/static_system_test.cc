// The body as a static solver sees it: its stiffness is symmetric and what forces change by, its
// preconditioner is near it, motions that nothing resists are found.
#include "src/simulation/equilibrium_solver.h"
#include "tests/support/small_plate.h"

#include <random>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
const std::string pulled =
    R"(/loads=[{"boundary": "top", "displacement": [null, 0.01], "ramp": 1}, {"boundary": "bottom", "displacement": [null, 0]}])";
const std::string held =
    R"(/loads=[{"boundary": "top", "displacement": [0.002, 0.01], "ramp": 1}, {"boundary": "bottom", "displacement": [0, 0]}])";

/// All ways to join the halves, and bodies of one half.
std::vector<BodyKind> all_kinds()
{
  std::vector<BodyKind> kinds = body_kinds;
  for (const char *scheme :
       {"acceleration", "pointwise", "xiao_belytschko", "xiao_belytschko_lumped"})
    kinds.push_back({scheme, {std::string("/coupling/scheme=\"") + scheme + "\""}});
  return kinds;
}

struct Solved
{
  SmallBody small;
  EquilibriumSolver<2> solver;

  explicit Solved(const std::vector<std::string> &overrides,
                  algebra::Preconditioning kind = algebra::Preconditioning::cholesky)
      : small(small_scene(overrides)), solver(small.body, kind)
  {
  }
  StaticSystem<2> &system() { return solver.system(); }

  Eigen::VectorXd noise(unsigned seed)
  {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    Eigen::VectorXd y =
        Eigen::VectorXd::NullaryExpr(system().size(), [&] { return uniform(random); });
    system().drop_inert(y);
    return y;
  }
};

class StaticSystems : public ::testing::TestWithParam<BodyKind>
{
};
INSTANTIATE_TEST_SUITE_P(, StaticSystems, ::testing::ValuesIn(all_kinds()),
                         [](const auto &info) { return std::string(info.param.name); });

TEST_P(StaticSystems, StiffnessIsSymmetric)
{
  Solved body(GetParam().overrides + std::vector{held});
  const Eigen::VectorXd x = body.noise(1), y = body.noise(2);
  const Eigen::VectorXd kx = body.system().stiffness_times(x),
                        ky = body.system().stiffness_times(y);
  EXPECT_GT(x.dot(kx), 0);
  EXPECT_NEAR(y.dot(kx), x.dot(ky), 1e-13 * x.norm() * ky.norm());
}

TEST_P(StaticSystems, StiffnessIsWhatForcesChangeBy)
{
  Solved body(GetParam().overrides + std::vector{held});
  auto &system = body.system();
  const Eigen::VectorXd y = body.noise(1), ky = system.stiffness_times(y);
  const double step = 1e-6; // spacings: errs by its square over round-off
  const auto start = system.place();
  system.displace(y, step);
  const Eigen::VectorXd up = system.forces(0);
  system.put_back(start);
  system.displace(y, -step);
  const Eigen::VectorXd down = system.forces(0);
  EXPECT_LT(((down - up) / (2 * step) - ky).norm(), 1e-7 * ky.norm());
}

TEST_P(StaticSystems, ReachesEquilibrium)
{
  Solved body(GetParam().overrides + std::vector{pulled});
  EXPECT_EQ(body.solver.n_free_motions(), 0); // not known yet
  Eigen::VectorXd moved;
  ASSERT_EQ(body.solver.find_equilibrium(1, moved), EquilibriumSolver<2>::End::converged);
  EXPECT_EQ(body.solver.n_free_motions(), 1); // sideways
  const Eigen::VectorXd left = body.system().forces(1);
  EXPECT_LT(left.norm(), 1.1e-9 * body.solver.largest_load());
  EXPECT_GT(body.solver.largest_load(), 1e-4);
  EXPECT_LT(body.solver.n_iterations(), 120) << body.solver.n_solves();
}

TEST(StaticSystem, PreconditionerOfAParticleBodyIsItsStiffness)
{
  for (const char *packing : {"\"hexagonal\"", "\"square\"", "\"random\""}) {
    SCOPED_TRACE(packing);
    Solved body({"/far_field=none", std::string("/discrete_zone/packing=") + packing, held});
    const Eigen::VectorXd y = body.noise(1), ky = body.system().stiffness_times(y);
    Eigen::VectorXd py;
    body.system().near_stiffness(1).multiply(y, py);
    EXPECT_LT((py - ky).norm(), 1e-12 * ky.norm());
  }
}

// A beam 200 long and 12 high with two arms, held by necks of two particles: turning about them
// costs 3e-11 of what stretching bonds does, but not nothing.
TEST(StaticSystem, NarrowSupportsHold)
{
  Solved body({"/far_field=none",
               "/discrete_zone={\"extent\": \"all\", \"packing\": \"hexagonal\", \"spacing\": 1}",
               "/specimen={\"size\": [200, 24], \"cracks\": [{\"points\": [[-100, 0], [-40, 0]]}], "
               "\"notches\": [{\"lower\": [-98, 6], \"upper\": [100, 12]}, "
               "{\"lower\": [-98, -12], \"upper\": [100, -6]}]}",
               pulled});
  Eigen::VectorXd moved;
  ASSERT_EQ(body.solver.find_equilibrium(1, moved), EquilibriumSolver<2>::End::converged);
  EXPECT_EQ(body.solver.n_free_motions(), 1); // sideways
}
} // namespace
