// Equilibria beside what else finds them: damped steps until nothing moves any more.
#include "core/extremes.h"
#include "src/simulation/damping.h"
#include "tests/support/static_body.h"

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
/// Largest difference of displacements over the largest one.
template <int dim>
double largest_difference(const CoupledBody<dim> &a, const CoupledBody<dim> &b)
{
  double difference = 0, largest = 0;
  const auto look = [&](const Components<dim> &x, const Components<dim> &y) {
    for (int c = 0; c < dim; ++c)
      for (std::size_t i = 0; i < x[c].size(); ++i) {
        keep_largest(difference, std::abs(x[c][i] - y[c][i]));
        keep_largest(largest, std::abs(y[c][i]));
      }
  };
  if (a.zone)
    look(a.zone->state.displacement, b.zone->state.displacement);
  if (a.far)
    look(a.far->displacement, b.far->displacement);
  return difference / largest;
}

/// The loop of a run: a ramp, then the loads stand still.
template <int dim>
void damp(CoupledBody<dim> &body, double rate, long n_steps)
{
  BodyDamping<dim> damping({0, rate, false});
  auto bodies = body.bodies();
  coupling::StepTime now{0, 0, body.dt};
  body.coupler->compute_forces(bodies, now);
  for (long step = 0; step < n_steps; ++step) {
    damping.before_kick(body, now);
    body.coupler->kick(bodies, now);
    damping.after_kick(body, now);
    body.coupler->drift(bodies, now);
    now.step = step + 1;
    now.time = double(now.step) * body.dt;
    body.coupler->compute_forces(bodies, now);
  }
}

constexpr double exact = 1e-8; // the solver leaves 1e-9 of the load

/// At strains of 1e-3 and a shear that turns the body by as much.
template <int dim>
void expect_that_steps_end_there(const std::vector<std::string> &overrides, double rate,
                                 long n_steps, double tolerance = exact)
{
  // Turns about several axes do not commute: in 3D the orientation of pads, which the mesh turns,
  // depends on the way there by the square of the angles. Waves would make these large.
  constexpr double ramp = 300;
  std::vector<std::string> scene =
      overrides + std::vector{dim == 2 ? loads({{"top", "displacement", {"0.3", "0.1"}},
                                                {"bottom", "displacement", {"0", "0"}}})
                                       : loads({{"top", "displacement", {"0.2", "0.05", "0.1"}},
                                                {"bottom", "displacement", {"0", "0", "0"}}})};
  std::string &list = scene.back();
  for (auto at = list.find("\"ramp\": 1}"); at != std::string::npos; at = list.find("\"ramp\": 1}"))
    list.replace(at, 10, "\"ramp\": " + std::to_string(ramp) + "}");
  StaticBody<dim> sought(scene), stepped(scene);
  Eigen::VectorXd moved;
  ASSERT_EQ(sought.solver.find_equilibrium(ramp, moved), EquilibriumSolver<dim>::End::converged);
  damp(stepped.body, rate, n_steps);
  const double difference = largest_difference(stepped.body, sought.body);
  std::printf("after %ld steps: displacements differ by %.2e\n", n_steps, difference);
  EXPECT_LT(difference, tolerance);
}

// The slowest of their waves takes 240 to come back: in 1e5 steps of 0.3 it is damped by e^-900.
TEST(StaticOracle, SlowDampedStepsOfACoupledPlate)
{
  expect_that_steps_end_there<2>({}, 0.03, 100000);
}
TEST(StaticOracle, SlowDampedStepsOfACoupledCrackedTurnedPlate)
{
  expect_that_steps_end_there<2>(
      {"/discrete_zone/orientation=0.2", "/specimen/cracks=[{\"points\": [[-5, -2], [4, 3]]}]"},
      0.03, 100000);
}
TEST(StaticOracle, SlowDampedStepsOfARandomPacking)
{
  expect_that_steps_end_there<2>(
      {"/far_field=none", "/discrete_zone/packing=\"random\"", "/specimen/size=[12, 30]"}, 0.1,
      100000);
}
TEST(StaticOracle, DampedStepsOfAMesh)
{
  expect_that_steps_end_there<2>({"/discrete_zone=none"}, 0.03, 20000);
}
// Critically damped in bending, of frequency 0.0126.
TEST(StaticOracle, SlowDampedStepsOfABar)
{
  constexpr double angle = 0.2 / 60;
  expect_that_steps_end_there<3>({}, 0.025, 10000, angle * angle);
}
TEST(StaticOracle, SlowDampedStepsOfABarOfParticles)
{
  expect_that_steps_end_there<3>({"/far_field=none", "/specimen/size=[5, 20, 4]"}, 0.1, 10000);
}
} // namespace
