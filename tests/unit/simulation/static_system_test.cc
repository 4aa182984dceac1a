// The body as a static solver sees it: its stiffness is symmetric and what forces change by, and
// its equilibrium is found in as many iterations as a good preconditioner leaves; in 2D and 3D.
#include "tests/support/static_body.h"

#include <functional>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
struct Kind
{
  std::string name;
  int dim;
  std::vector<std::string> overrides;
  int most_iterations = 60; // per Newton step, to 1e-5 of its right-hand side
};

// Its constraint is no projection (see StaticTransposes), so that y keeps what the others take out
// of it: gaps in the overlap, of which the weighted halves resist little.
constexpr int lumped_iterations = 120;

const std::string
    square = "/discrete_zone/packing=\"square\"",
    random_packing = "/discrete_zone/packing=\"random\"", pure = "/far_field=none",
    crack = "/specimen/cracks=[{\"points\": [[-5, -2], [4, 3]]}]",
    soft_disc =
        R"(/inclusions=[{"balls": [{"centre": [2, 0], "radius": 3}], "youngs_modulus": 0.1, "density": 1, "poissons_ratio": 0.3}])",
    hard_box =
        R"(/inclusions=[{"boxes": [{"lower": [-2, -3, -2], "upper": [4, 2, 2]}], "youngs_modulus": 10, "density": 1, "poissons_ratio": 0.1}])";

std::string nu(const std::string &value)
{
  return "/material/poissons_ratio=" + value;
}
std::string scheme(const std::string &name)
{
  return "/coupling/scheme=\"" + name + "\"";
}

std::vector<Kind> all_kinds()
{
  std::vector<Kind> kinds;
  for (const int dim : {2, 3}) {
    const std::string end = dim == 2 ? "_2d" : "_3d";
    const auto add = [&](const std::string &name, const std::vector<std::string> &overrides,
                         int most = 60) {
      kinds.push_back({name + end, dim, overrides, most});
      // Three dimensions of particles alone take a while to factorise.
      if (dim == 3 && !overrides.empty() && overrides[0] == pure)
        kinds.back().overrides.push_back("/specimen/size=[5, 20, 4]");
    };
    add("coupled", {});
    add("coupled_random", {random_packing});
    add("coupled_nu_0", {nu("0")});
    add("coupled_nu_049", {nu("0.49"), "/time/step_fraction=0.7"});
    add("pure_dem", {pure});
    add("pure_dem_random_nu_049", {pure, random_packing, nu("0.49")});
    add("pure_fem", {"/discrete_zone=none"});
    for (const char *name : {"acceleration", "pointwise", "xiao_belytschko"})
      add(name, {scheme(name)}, 100);
  }
  kinds.push_back(
      {"xiao_belytschko_lumped", 2, {scheme("xiao_belytschko_lumped")}, lumped_iterations});
  kinds.push_back({"coupled_square", 2, {square}});
  kinds.push_back({"coupled_crack", 2, {crack}});
  kinds.push_back({"coupled_turning", 2, {"/coupling/regime=\"corotated\""}});
  kinds.push_back({"coupled_soft_disc", 2, {soft_disc}});
  kinds.push_back({"pure_random_soft_disc", 2, {pure, random_packing, soft_disc}});
  kinds.push_back({"pure_simple_cubic",
                   3,
                   {pure, "/discrete_zone/packing=\"simple_cubic\"", "/specimen/size=[5, 20, 4]"}});
  kinds.push_back({"coupled_hard_box", 3, {hard_box}});
  return kinds;
}

class StaticSystems : public ::testing::TestWithParam<Kind>
{
protected:
  /// test(StaticBody) of the dimension, its loads those of this motion of the ends.
  template <typename Test>
  static void with_body(bool is_held, Test &&test)
  {
    const Kind &kind = GetParam();
    const std::string side = is_held ? "0.002" : "null", still = is_held ? "0" : "null";
    if (kind.dim == 2) {
      StaticBody<2> body(kind.overrides +
                         std::vector{loads({{"top", "displacement", {side, "0.01"}},
                                            {"bottom", "displacement", {still, "0"}}})});
      test(body);
    } else {
      StaticBody<3> body(kind.overrides +
                         std::vector{loads({{"top", "displacement", {side, "0.01", still}},
                                            {"bottom", "displacement", {still, "0", still}}})});
      test(body);
    }
  }
};
INSTANTIATE_TEST_SUITE_P(, StaticSystems, ::testing::ValuesIn(all_kinds()),
                         [](const auto &info) { return info.param.name; });

std::vector<Kind> kinds_that(const std::function<bool(const Kind &)> &suit)
{
  std::vector<Kind> kinds;
  for (const Kind &kind : all_kinds())
    if (suit(kind))
      kinds.push_back(kind);
  return kinds;
}

/// Faces of a crack that are about to touch make a corner of the forces.
class SmoothSystems : public StaticSystems
{
};
INSTANTIATE_TEST_SUITE_P(, SmoothSystems, ::testing::ValuesIn(kinds_that([](const Kind &kind) {
                           return kind.name != "coupled_crack";
                         })),
                         [](const auto &info) { return info.param.name; });

/// Without a mesh, and without bonds of two materials, of which the matrix knows no more than the
/// shorter way.
class ParticleSystems : public StaticSystems
{
};
INSTANTIATE_TEST_SUITE_P(, ParticleSystems, ::testing::ValuesIn(kinds_that([](const Kind &kind) {
                           return !kind.overrides.empty() && kind.overrides[0] == pure &&
                                  kind.name != "pure_random_soft_disc";
                         })),
                         [](const auto &info) { return info.param.name; });

TEST_P(StaticSystems, StiffnessIsSymmetric)
{
  with_body(true, [](auto &body) {
    const Eigen::VectorXd x = body.noise(1), y = body.noise(2);
    const Eigen::VectorXd kx = body.system().stiffness_times(x),
                          ky = body.system().stiffness_times(y);
    EXPECT_GT(x.dot(kx), 0);
    EXPECT_NEAR(y.dot(kx), x.dot(ky), 1e-13 * x.norm() * ky.norm());
  });
}

TEST_P(SmoothSystems, StiffnessIsWhatForcesChangeBy)
{
  with_body(true, [](auto &body) {
    const Eigen::VectorXd y = body.noise(1), ky = body.system().stiffness_times(y);
    EXPECT_LT((body.force_difference(y) - ky).norm(), 1e-7 * ky.norm());
  });
}

TEST_P(StaticSystems, ReachesEquilibrium)
{
  with_body(false, [](auto &body) {
    using Solver = std::decay_t<decltype(body.solver)>;
    EXPECT_EQ(body.solver.n_free_motions(), 0); // not known yet
    Eigen::VectorXd moved;
    ASSERT_EQ(body.solver.find_equilibrium(1, moved), Solver::End::converged);
    EXPECT_EQ(body.solver.n_free_motions(), GetParam().dim == 2 ? 1 : 3); // sideways, turning
    EXPECT_LT(body.system().forces(1).norm(), 1.1e-9 * body.solver.largest_load());
    EXPECT_GT(body.solver.largest_load(), 1e-4);
    ::testing::Test::RecordProperty("iterations", body.solver.n_iterations());
    std::printf("%s: %d solves, %d iterations\n", GetParam().name.c_str(), body.solver.n_solves(),
                body.solver.n_iterations());
    EXPECT_LE(body.solver.n_iterations(), body.solver.n_solves() * GetParam().most_iterations);
  });
}

// Where no mesh is, the matrix of the preconditioner is the stiffness itself in 2D. In 3D pressures
// are left out of it where they are small: lambda tr^2 is at most 3 lambda/(2 G) times 2 G |e|^2.
TEST_P(ParticleSystems, PreconditionerIsTheirStiffness)
{
  with_body(true, [](auto &body) {
    const auto &k = body.body.force()->elastic_constants();
    const double nu = k.poissons_ratio;
    for (const Eigen::VectorXd &y :
         {body.noise(1), Eigen::VectorXd(body.system().rigid_motions().rowwise().sum().cwiseProduct(
                             body.noise(2)))})
    {
      const Eigen::VectorXd ky = body.system().stiffness_times(y);
      Eigen::VectorXd py;
      body.system().near_stiffness(1).multiply(y, py);
      if (GetParam().dim == 2 || nu > 0.3) {
        EXPECT_LT((py - ky).norm(), 1e-12 * ky.norm());
        continue;
      }
      EXPECT_LE(y.dot(py), y.dot(ky) * (1 + 1e-12));
      EXPECT_GE(y.dot(py) * (1 + 3 * nu / (1 - 2 * nu)), y.dot(ky));
      EXPECT_GT((py - ky).norm(), 1e-6 * ky.norm());
    }
  });
}

// A constant load lets halves that the lumped constraint joins creep apart
// (docs/verification_schemes .md), and in 3D nothing else holds them.
TEST(StaticSystem, SlowTheLumpedConstraintHasNoEquilibriumIn3d)
{
  StaticBody<3> body(std::vector{scheme("xiao_belytschko_lumped"),
                                 loads({{"top", "displacement", {"null", "0.01", "null"}},
                                        {"bottom", "displacement", {"null", "0", "null"}}})});
  const auto start = body.system().place();
  Eigen::VectorXd moved;
  EXPECT_NE(body.solver.find_equilibrium(1, moved), EquilibriumSolver<3>::End::converged);
  EXPECT_EQ(body.system().place().zone, start.zone);
}
} // namespace
