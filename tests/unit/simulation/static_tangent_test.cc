// The stiffness of a body that has turned: what its forces change by there, and no longer positive
// where it buckles; and a solver that finds no balance leaves the body as it was.
#include "dem/many_body_force.h"
#include "tests/support/static_body.h"

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
const std::string slender = "/specimen/size=[4, 60]", pure = "/far_field=none";

/// A column that the top bends by a tenth of its length.
std::string bend()
{
  return loads({{"top", "displacement", {"6", "0"}}, {"bottom", "displacement", {"0", "0"}}});
}

/// Of a body that its loads have bent.
template <int dim>
void expect_stiffness_of_forces(const std::vector<std::string> &overrides)
{
  StaticBody<dim> one(overrides);
  for (const double time : {0.25, 0.5, 0.75, 1.}) {
    Eigen::VectorXd moved;
    ASSERT_EQ(one.solver.find_response(time - 0.25, time, moved),
              EquilibriumSolver<dim>::End::converged);
    one.system().displace(moved);
    ASSERT_EQ(one.solver.find_equilibrium(time, moved), EquilibriumSolver<dim>::End::converged);
  }
  one.system().forces(1);
  one.system().linearise_here();
  const Eigen::VectorXd x = one.noise(1), y = one.noise(2);
  const Eigen::VectorXd kx = one.system().stiffness_times(x), ky = one.system().stiffness_times(y);
  EXPECT_NEAR(y.dot(kx), x.dot(ky), 1e-7 * x.norm() * ky.norm());

  const auto start = one.system().place();
  constexpr double step = 1e-5;
  one.system().displace(y, step);
  const Eigen::VectorXd up = one.system().forces(1);
  one.system().put_back(start);
  one.system().displace(y, -step);
  const Eigen::VectorXd down = one.system().forces(1);
  one.system().put_back(start);
  EXPECT_LT(((down - up) / (2 * step) - ky).norm(), 1e-7 * ky.norm());

  one.system().linearise_at_reference();
  EXPECT_GT((one.system().stiffness_times(y) - ky).norm(), 1e-3 * ky.norm());
}

// Steps of 1e-4 d on either side lack their square, and more round-off the smoother a motion is.
TEST(StaticTangent, IsWhatForcesChangeByInABentBody)
{
  const std::string two_materials =
      R"(/inclusions=[{"youngs_modulus": 0.3, "poissons_ratio": 0.4, "density": 1,
                       "boxes": [{"lower": [-2, -10], "upper": [0, 10]}]}])";
  for (const std::string packing : {"hexagonal", "square", "random"})
    for (const std::string change : {std::string("/plane=strain"), std::string("/plane=stress"),
                                     std::string("/material/poissons_ratio=-0.2"),
                                     std::string("/material/poissons_ratio=0.45"), two_materials})
    {
      SCOPED_TRACE(packing + " " + change);
      expect_stiffness_of_forces<2>(
          {slender, pure, "/discrete_zone/packing=\"" + packing + "\"", bend(), change});
    }
}

TEST(StaticTangent, IsWhatForcesChangeByInABentBar)
{
  const std::string bent = loads(
      {{"top", "displacement", {"2", "0.1", "-1"}}, {"bottom", "displacement", {"0", "0", "0"}}});
  for (const std::string packing : {"fcc", "simple_cubic", "random"})
    for (const std::string nu : {"-0.2", "0.22", "0.45"}) {
      SCOPED_TRACE(packing + " " + nu);
      expect_stiffness_of_forces<3>({"/specimen/size=[4, 40, 4]", pure,
                                     "/discrete_zone/packing=\"" + packing + "\"", bent,
                                     "/material/poissons_ratio=" + nu});
    }
}

// Newton's method with the stiffness of the present place: errors are squared.
TEST(StaticTangent, BringsABentBodyIntoBalanceInAFewSolves)
{
  StaticBody<2> one(std::vector<std::string>{slender, pure, bend()});
  Eigen::VectorXd moved;
  ASSERT_EQ(one.solver.find_equilibrium(1, moved), EquilibriumSolver<2>::End::converged);
  const int first = one.solver.n_solves();
  one.system().displace(one.noise(1), 1e-6);
  ASSERT_EQ(one.solver.find_equilibrium(1, moved), EquilibriumSolver<2>::End::converged);
  std::printf("%d solves from rest, %d from a place nearby\n", first,
              one.solver.n_solves() - first);
  EXPECT_LE(one.solver.n_solves() - first, 2);
}

// Free at its top: P = pi^2 E I / (4 L^2), E of plane strain, I = w^3/12. What nudges it across is
// answered by any stiffness but one that helps it.
TEST(StaticTangent, IsNoLongerPositiveAboveTheBucklingLoad)
{
  using End = EquilibriumSolver<2>::End;
  const double w = 4, length = 60, modulus = 1 / (1 - 0.22 * 0.22);
  const double critical = M_PI * M_PI * modulus * w * w * w / 12 / (4 * length * length) / w;
  const auto end_at = [&](double share) {
    StaticBody<2> one({slender, pure,
                       loads({{"top", "traction", {"0", std::to_string(-share * critical)}},
                              {"bottom", "displacement", {"0", "0"}}})});
    Eigen::VectorXd moved;
    const End straight = one.solver.find_equilibrium(1, moved);
    if (straight != End::converged)
      return straight;
    one.system().displace(one.noise(3), 1e-7);
    return one.solver.find_equilibrium(1, moved);
  };
  EXPECT_EQ(end_at(0.9), End::converged);
  EXPECT_EQ(end_at(1.1), End::indefinite);
}

/// Forces that turn round whenever they are asked for.
class RestlessForce : public dem::ManyBodyForce<2>
{
public:
  using dem::ManyBodyForce<2>::ManyBodyForce;
  void compute_trial(particles::Particles<2> &p, double time, double noted_share) override
  {
    dem::ManyBodyForce<2>::compute_trial(p, time, noted_share);
    sign_ = -sign_;
    p.force[0][p.size() / 2] += sign_ * 1e-3;
  }

private:
  double sign_ = 1;
};

TEST(StaticSolver, StallsAtForcesThatNeverBalance)
{
  const ForceMaker<2> make_restless = [](const Scene &scene, packings::Packing<2> packing,
                                         const std::vector<core::BoundaryLoad<2>> &loads,
                                         std::map<std::string, Figure> &, core::Log &) {
    const auto &m = scene.material;
    return std::make_unique<RestlessForce>(
        packing, dem::DemMaterial{m.youngs_modulus, m.poissons_ratio, m.density}, loads);
  };
  SmallBody one(small_scene({slender, pure, bend()}), make_restless);
  EquilibriumSolver<2> solver(one.body, algebra::Preconditioning::cholesky);
  const auto start = solver.system().place();
  Eigen::VectorXd moved;
  EXPECT_EQ(solver.find_equilibrium(1, moved), EquilibriumSolver<2>::End::stalled);
  EXPECT_LT(solver.n_solves(), 31);
  EXPECT_EQ(solver.system().place().zone, start.zone);
  EXPECT_EQ(solver.system().place().rotation, start.rotation);
}
} // namespace
