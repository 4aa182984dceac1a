// Motions of the whole body that no support resists: as many as one counts by hand.
#include "src/simulation/static_phases.h"
#include "tests/support/static_body.h"

#include <optional>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
const std::string no = "null";
const std::vector<std::vector<std::string>> kinds = {
    {}, {"/far_field=none"}, {"/discrete_zone=none"}};

/// After an equilibrium at full load, or the attempt.
template <int dim>
int n_free(const std::vector<Load> &list, const std::vector<std::string> &overrides)
{
  // A small one: three dimensions of particles alone take a while to factorise.
  const std::vector<std::string> size = dim == 3 && !overrides.empty()
                                            ? std::vector<std::string>{"/specimen/size=[5, 20, 4]"}
                                            : std::vector<std::string>{};
  StaticBody<dim> body(overrides + size + std::vector{loads(list)});
  Eigen::VectorXd moved;
  EXPECT_EQ(body.solver.find_equilibrium(1, moved), EquilibriumSolver<dim>::End::converged);
  return body.solver.n_free_motions();
}

struct Counted
{
  const char *what;
  std::vector<Load> loads;
  int n;
};

TEST(FreeMotions, OfAPlate)
{
  const std::vector<Counted> sets = {
      {"pulled by tractions: two translations, one rotation",
       {{"top", "traction", {no, "1e-4"}}, {"bottom", "traction", {no, "-1e-4"}}},
       3},
      {"ends held along the pull: sideways",
       {{"top", "displacement", {no, "0.01"}}, {"bottom", "displacement", {no, "0"}}},
       1},
      {"one end held along the pull, the other drawn: sideways",
       {{"top", "traction", {no, "1e-4"}}, {"bottom", "displacement", {no, "0"}}},
       1},
      {"one end held: none",
       {{"top", "traction", {no, "1e-4"}}, {"bottom", "displacement", {"0", "0"}}},
       0},
      {"one end held sideways only: along it and no turn",
       {{"top", "traction", {no, "1e-4"}},
        {"bottom", "traction", {no, "-1e-4"}},
        {"left", "displacement", {"0", no}}},
       1},
      {"corner sides held across: none",
       {{"left", "displacement", {"0", no}},
        {"bottom", "displacement", {no, "0"}},
        {"top", "traction", {no, "1e-4"}}},
       0},
  };
  for (const Counted &set : sets)
    for (const auto &kind : kinds) {
      // Beside a zone that reaches the sides, only the mesh or only particles can be held there.
      if (kind.empty() && (std::string(set.loads.back().side) == "left" ||
                           std::string(set.loads[0].side) == "left"))
        continue;
      SCOPED_TRACE(std::string(set.what) + (kind.empty() ? "" : kind[0]));
      EXPECT_EQ(n_free<2>(set.loads, kind), set.n);
    }
}

TEST(FreeMotions, OfABar)
{
  const std::vector<Counted> sets = {
      {"pulled by tractions: all six",
       {{"top", "traction", {no, "1e-4", no}}, {"bottom", "traction", {no, "-1e-4", no}}},
       6},
      {"ends held along the pull: two sideways, and a turn about the axis",
       {{"top", "displacement", {no, "0.01", no}}, {"bottom", "displacement", {no, "0", no}}},
       3},
      {"one end held along it and across: the other way across",
       {{"top", "traction", {no, "1e-4", no}}, {"bottom", "displacement", {"0", "0", no}}},
       1},
      {"one end held: none",
       {{"top", "traction", {no, "1e-4", no}}, {"bottom", "displacement", {"0", "0", "0"}}},
       0},
  };
  for (const Counted &set : sets)
    for (const auto &kind : kinds) {
      SCOPED_TRACE(std::string(set.what) + (kind.empty() ? "" : kind[0]));
      EXPECT_EQ(n_free<3>(set.loads, kind), set.n);
    }
}

// A beam of 84 mm with two arms, held by necks of two particles: turning about them costs 2e-11 of
// what stretching bonds does, but not nothing.
TEST(FreeMotions, NarrowSupportsHold)
{
  StaticBody<2> body(std::vector<std::string>{
      "/far_field=none",
      R"(/discrete_zone={"extent": "all", "packing": "hexagonal", "spacing": 5e-4})",
      R"(/specimen={"size": [0.084, 0.024], "cracks": [{"points": [[-0.042, 0], [-0.009, 0]]}],
         "notches": [{"lower": [-0.041, 0.008], "upper": [0.042, 0.012]},
                     {"lower": [-0.041, -0.012], "upper": [0.042, -0.008]}]})",
      loads(
          {{"top", "displacement", {"null", "1e-7"}}, {"bottom", "displacement", {"null", "0"}}})});
  Eigen::VectorXd moved;
  ASSERT_EQ(body.solver.find_equilibrium(1, moved), EquilibriumSolver<2>::End::converged);
  EXPECT_EQ(body.solver.n_free_motions(), 1); // sideways
}

// Particles that have turned move freely about where they are, the linear mesh about where it was:
// what is projected out is near to what nothing resists, not equal to it.
TEST(StaticFreeMotions, OfACoupledBarThatHasBentAndStretched)
{
  StaticBody<3> one(std::vector<std::string>{
      R"(/specimen/notches=[{"lower": [-4, -0.6, -3.5], "upper": [0, 0.6, 3.5]}])",
      loads({{"top", "displacement", {"null", "0.3", "null"}},
             {"bottom", "displacement", {"null", "-0.3", "null"}}})});
  Eigen::VectorXd moved;
  ASSERT_EQ(one.solver.find_equilibrium(0.8, moved), EquilibriumSolver<3>::End::converged);
  EXPECT_EQ(one.solver.n_free_motions(), 3); // sideways, turning
  one.solver.renew();
  const int before = one.solver.n_iterations();
  ASSERT_EQ(one.solver.find_response(0.8, 1, moved), EquilibriumSolver<3>::End::converged);
  EXPECT_LE(one.solver.n_iterations() - before, 60);
  ASSERT_EQ(one.solver.find_equilibrium(1, moved), EquilibriumSolver<3>::End::converged);
  EXPECT_LT(one.solver.unresisted_share(), 1e-4);
}

/// What an equilibrium under these loads leaves out of them.
template <int dim>
double unresisted(const std::vector<Load> &list, const std::vector<std::string> &kind)
{
  StaticBody<dim> body(kind + std::vector{loads(list)});
  Eigen::VectorXd moved;
  EXPECT_EQ(body.solver.find_equilibrium(1, moved), EquilibriumSolver<dim>::End::converged);
  return body.solver.unresisted_share();
}

TEST(StaticFreeMotions, LoadsOutOfBalanceAreNoticed)
{
  for (const auto &kind : kinds) {
    SCOPED_TRACE(kind.empty() ? "coupled" : kind[0]);
    // Traction at one end alone moves the body as a whole, and of 3 against 1 half of the sum does.
    EXPECT_NEAR(unresisted<2>({{"top", "traction", {no, "1e-4"}}}, kind), 1, 0.02);
    EXPECT_NEAR(
        unresisted<2>({{"top", "traction", {no, "3e-4"}}, {"bottom", "traction", {no, "-1e-4"}}},
                      kind),
        0.5, 0.01);
    EXPECT_LT(unresisted<2>(
                  {{"top", "traction", {no, "1e-4"}}, {"bottom", "traction", {no, "-1e-4"}}}, kind),
              1e-8);
    EXPECT_EQ(
        unresisted<2>({{"top", "traction", {no, "1e-4"}}, {"bottom", "displacement", {"0", "0"}}},
                      kind),
        0);
  }
}

TEST(StaticFreeMotions, ARunIsToldOnce)
{
  const auto overrides = [](const std::string &bottom) {
    return std::vector<std::string>{
        "/time/loading=static",
        loads({{"top", "traction", {no, "1e-4"}}, {"bottom", "traction", {no, bottom}}})};
  };
  for (const bool is_balanced : {true, false}) {
    const auto scene = overrides(is_balanced ? "-1e-4" : "-0.9e-4");
    StaticBody<2> plate(scene);
    StaticPhases<2> phases(static_scene<2>(scene), plate.body, plate.log);
    Clock clock;
    clock.now = {0, 0, plate.body.dt};
    const int ratio = plate.body.coupler->step_ratio();
    clock.n_steps = long(1 / plate.body.dt) / ratio * ratio;
    const auto look = []() -> std::optional<Stop> { return {}; };
    EXPECT_FALSE(phases.advance(plate.body, clock, 0, look));
    ASSERT_EQ(plate.log.warnings().size(), is_balanced ? 0 : 1);
    if (!is_balanced) {
      EXPECT_EQ(plate.log.warnings()[0].rfind("nothing resists 0.05", 0), 0)
          << plate.log.warnings()[0];
    }
  }
}
} // namespace
