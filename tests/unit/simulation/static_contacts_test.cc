// Equilibria of bodies whose faces touch: an initial crack under compression, with and without
// friction.
#include "tests/support/static_body.h"

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
const std::string inclined = R"(/specimen/cracks=[{"points": [[-6, -3], [6, 3]]}])";

std::string friction(double value)
{
  return "/material/friction=" + std::to_string(value);
}
/// Of both ends along the plate, tension above 0.
std::string ends(double way)
{
  return loads({{"top", "displacement", {"null", std::to_string(way)}},
                {"bottom", "displacement", {"0", "0"}}});
}

struct Cut
{
  const char *name;
  double friction;
  std::vector<std::string> overrides;
};

class StaticContacts : public ::testing::TestWithParam<Cut>
{
protected:
  static std::vector<std::string> scene(double way)
  {
    return GetParam().overrides + std::vector{inclined, friction(GetParam().friction), ends(way)};
  }
};
INSTANTIATE_TEST_SUITE_P(
    , StaticContacts,
    ::testing::Values(Cut{"smooth", 0, {}}, Cut{"rough", 2, {}},
                      Cut{"smooth_pure", 0, {"/far_field=none"}},
                      Cut{"rough_pure", 2, {"/far_field=none"}},
                      Cut{"smooth_random", 0, {"/discrete_zone/packing=\"random\""}}),
    [](const auto &info) { return std::string(info.param.name); });

/// A little pressure, in a step that counts: its faces touch from then on, and friction knows from
/// where they slide.
void touch(StaticBody<2> &one)
{
  constexpr double strain = -1e-9;
  const double nu = 0.22;
  Eigen::VectorXd y = one.system().rigid_motions().col(0);
  for (int k = 0; k < y.size() / 3; ++k)
    y.segment<3>(3 * k).setZero();
  auto &state = one.body.zone->state;
  const auto put = [&](int row, const Vector<2> &x) {
    y.segment<2>(3 * row) = strain * Vector<2>(-nu / (1 - nu) * x[0], x[1] + 60);
  };
  for (int i = 0; i < state.size(); ++i)
    put(i, get(state.reference, i));
  for (int i = 0; one.body.far && i < one.body.far->mesh().n_nodes(); ++i)
    put(state.size() + i, one.body.far->mesh().nodes[i]);
  one.system().displace(y);
  auto bodies = one.body.bodies();
  one.body.coupler->compute_forces(bodies, {0, 0, one.body.dt});
}

/// Mean pressure (E) under the top.
double pressure(StaticBody<2> &one)
{
  double sum = 0;
  if (one.body.zone)
    sum += one.body.force()->reaction(0)[1];
  if (one.body.far)
    sum += one.body.far->reaction(0)[1];
  return std::abs(sum) / 24;
}

TEST_P(StaticContacts, ClosedFacesAreInBalanceAndInTheStiffness)
{
  StaticBody<2> one(scene(-0.02));
  touch(one);
  Eigen::VectorXd moved;
  ASSERT_EQ(one.solver.find_equilibrium(1, moved), EquilibriumSolver<2>::End::converged);
  EXPECT_LT(one.system().forces(1).norm(), 1.1e-9 * one.solver.largest_load());

  // Faces that touch resist: K is stiffer than that of the open crack by one-sided terms.
  one.system().linearise_at_reference(); // where it is exact to round-off
  const Eigen::VectorXd x = one.noise(1), y = one.noise(2);
  const Eigen::VectorXd kx = one.system().stiffness_times(x), ky = one.system().stiffness_times(y);
  EXPECT_NEAR(y.dot(kx), x.dot(ky), 1e-13 * x.norm() * ky.norm());
  StaticBody<2> open(scene(0.02)); // nothing touches at its start
  const Eigen::VectorXd open_kx = open.system().stiffness_times(x);
  EXPECT_GT(x.dot(kx), x.dot(open_kx) * (1 + 1e-6));

  Eigen::VectorXd py;
  one.system().near_stiffness(1).multiply(y, py);
  EXPECT_GT(y.dot(py), 0);
  if (!one.body.far) {
    EXPECT_LT((py - ky).norm(), 1e-12 * ky.norm());
  }
}

// Under tension a crack is a crack whatever its friction; pressed, a rough one carries as if it
// were not there, and a smooth one less.
TEST_P(StaticContacts, OpenOrClosedAsTheLoadHasIt)
{
  const auto modulus = [&](const std::vector<std::string> &overrides, bool is_pressed) {
    StaticBody<2> one(overrides);
    if (is_pressed)
      touch(one);
    Eigen::VectorXd moved;
    EXPECT_EQ(one.solver.find_equilibrium(1, moved), EquilibriumSolver<2>::End::converged);
    one.system().forces(1);
    return pressure(one) / (0.02 / 120);
  };
  const auto whole = [&](double way) {
    return modulus(GetParam().overrides + std::vector{ends(way)}, false);
  };
  const double loss_open = 1 - modulus(scene(0.02), false) / whole(0.02),
               loss_closed = 1 - modulus(scene(-0.02), true) / whole(-0.02);
  std::printf("%s: a crack takes %.4f of the stiffness open, %.4f closed\n", GetParam().name,
              loss_open, loss_closed);
  EXPECT_GT(loss_open, 0.01);
  EXPECT_LT(loss_closed, 0.8 * loss_open);
  if (GetParam().friction > 1)
    EXPECT_LT(std::abs(loss_closed), 0.05 * loss_open);
  else
    EXPECT_GT(loss_closed, 0.05 * loss_open);
}

// Whether friction holds them or they slide against it, from the first touch on or from one before.
TEST(StaticContact, FacesThatSlideComeIntoBalance)
{
  for (const double coefficient : {0.2, 2.})
    for (const bool touches : {false, true}) {
      SCOPED_TRACE(coefficient);
      StaticBody<2> one(std::vector<std::string>{inclined, friction(coefficient), ends(-0.02)});
      if (touches)
        touch(one);
      Eigen::VectorXd moved;
      ASSERT_EQ(one.solver.find_equilibrium(1, moved), EquilibriumSolver<2>::End::converged);
      EXPECT_LT(one.system().forces(1).norm(), 1.1e-9 * one.solver.largest_load());
    }
}
} // namespace
