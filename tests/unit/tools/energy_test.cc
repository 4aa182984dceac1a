// Ledger and momentum of bodies that tools push, hit and leave.
#include "tests/support/tool_body.h"

#include <fmt/format.h>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
struct Course
{
  double residual = 0; // J, the largest
  double work = 0;     // J, at the end
  double area = 0;     // m^2, the largest
  EnergyLedger last;
};

/// Until a time in s.
template <int dim>
Course run(ToolBody<dim> &b, double until)
{
  Course course;
  while (b.now.time < until) {
    b.far_step();
    course.last = b.ledger();
    course.residual = std::max(course.residual, std::abs(course.last.residual()));
    course.area = std::max(course.area, b.body.tools->read(0).area);
    course.work = std::max(course.work, course.last.external_work);
  }
  return course;
}

const std::vector<BodyKind> kinds = {
    {"coupled", {}},
    {"coupled, far field in every third step", {"/coupling/step_ratio=3"}},
    {"pure_dem", {"/far_field=none"}},
    {"pure_fem", {"/discrete_zone=none"}}};

// A ball flies into the end of the bar and bounces back.
const std::string projectile = R"(/tools=[{"name": "ball", "shape": "ball", "radius": 12,
  "place": [0.4, 72.3], "mass": 30, "initial_velocity": [0, -0.01]}])";

TEST(ToolEnergy, TheLedgerOfAnImpactCloses)
{
  for (const auto &kind : kinds) {
    SCOPED_TRACE(kind.name);
    ToolBody<2> b(kind.overrides + std::vector<std::string>{projectile});
    const double start = b.ledger().external_work;
    EXPECT_NEAR(start, 30 * 1e-4 / 2, 1e-15);
    const Course course = run(b, 500);
    EXPECT_GT(b.body.tools->read(0).velocity[1], 1e-4); // it came back
    EXPECT_LT(course.last.tools.kinetic, 0.9 * start);  // and left something behind
    // A point that touches or parts within a step: the trapezoid of its force misses at most
    // K (v dt)^2/8. Each does both; on the way out v is no larger.
    const double stiffness = 2 * course.area / (b.body.zone && !b.body.far ? 1 : 4.),
                 step = b.now.dt * b.body.coupler->step_ratio();
    EXPECT_LT(course.residual, stiffness * std::pow(0.01 * step, 2) / 4);
  }
}

// What is left over is of second order in the step.
TEST(ToolEnergy, TheResidualFallsWithTheSquareOfTheStep)
{
  double residual[2];
  for (const int k : {0, 1}) {
    ToolBody<2> b({"/far_field=none", projectile, fmt::format("/time/step={}", k ? 0.1 : 0.4)});
    residual[k] = run(b, 300).residual;
  }
  EXPECT_GT(residual[0], 8 * residual[1]);
}

template <int dim>
void expect_momentum(const std::string &tool, double friction_heat)
{
  ToolBody<dim> b({"/far_field=none", tool});
  const double mass = b.tools().tool(0).definition().mass;
  const Vector<dim> start = mass * b.tools().tool(0).definition().velocity;
  double pushed = 0;
  for (int n = 0; n < 800; ++n) {
    b.step();
    // The tool was kicked in act(): the body's own kick is still to come.
    Vector<dim> body = b.momentum();
    for (int c = 0; c < dim; ++c)
      for (const double f : b.body.zone->state.force[c])
        body[c] += b.now.dt * f;
    pushed = std::max(pushed, body.norm());
    EXPECT_NEAR((body + mass * b.body.tools->read(0).velocity - start).norm() / start.norm(), 0,
                1e-12);
  }
  EXPECT_GT(pushed, 0.5 * start.norm());
  EXPECT_GE(b.body.tools->energy().friction, friction_heat);
}

TEST(ToolEnergy, ProjectileAndBodyKeepTheirMomentum)
{
  expect_momentum<2>(R"(/tools=[{"name": "ball", "shape": "ball", "radius": 12, "place": [3, 72.3],
    "mass": 30, "inertia": 900, "friction": 0.3, "initial_velocity": [0.005, -0.01]}])",
                     1e-9);
  expect_momentum<3>(
      R"(/tools=[{"name": "ball", "shape": "ball", "radius": 5, "place": [1, 35.3, 1],
    "mass": 60, "inertia": 600, "friction": 0.3, "initial_velocity": [0.004, -0.01, 0]}])",
      1e-9);
}

// Along the right side from the zone over the overlap into the far field, with friction.
TEST(ToolEnergy, ARollerCrossesTheOverlap)
{
  for (const auto &kind : kinds) {
    SCOPED_TRACE(kind.name);
    ToolBody<2> b(kind.overrides +
                  std::vector<std::string>{
                      "/loads=[{\"boundary\": \"bottom\", \"displacement\": [0, 0]},"
                      "{\"boundary\": \"top\", \"displacement\": [0, 0]}]",
                      "/time/duration=2000", R"(/tools=[{"name": "roller", "shape": "roller",
        "radius": 20, "place": [32, 5], "velocity": [-1e-3, 2e-2], "friction": 0.2,
        "history": {"table": [[0, 0], [50, 1]]}}])"});
    const Course course = run(b, 1500);
    EXPECT_GT(b.body.tools->read(0).displacement[1], 25);
    EXPECT_GT(course.last.tools.friction, 0.1 * course.work);
    EXPECT_LT(course.residual / course.work, 2e-3);
  }
}

TEST(ToolEnergy, AReleasedToolTakesItsEnergyWithIt)
{
  for (const auto &kind : kinds) {
    SCOPED_TRACE(kind.name);
    ToolBody<2> b(
        kind.overrides +
        std::vector<std::string>{
            "/loads=[{\"boundary\": \"bottom\", \"displacement\": [0, 0]}]",
            R"(/tools=[{"name": "plate", "shape": "plate", "size": [30, 4], "place": [0, 62],
        "displacement": [null, -0.2], "ramp": 200, "release": 300}])",
            "/time/duration=400"});
    const Course pressed = run(b, 270);
    ASSERT_GT(pressed.last.tools.contact, 0);
    const Course after = run(b, 400);
    EXPECT_EQ(after.last.tools.contact, 0);
    EXPECT_EQ(b.body.tools->read(0).force.norm(), 0);
    // With impulses the invariant has more terms in the force, of second order in the step.
    EXPECT_LT(after.residual / pressed.work, b.body.coupler->step_ratio() > 1 ? 5e-3 : 2e-4);
  }
}

// A tool at a spring comes to rest where the spring pulls as the body pushes.
TEST(ToolEnergy, ASpringYields)
{
  ToolBody<2> b({"/far_field=none", "/time/duration=4000", "/damping/mass=0.02",
                 "/loads=[{\"boundary\": \"bottom\", \"displacement\": [0, 0]}]",
                 R"(/tools=[{"name": "plate", "shape": "plate", "size": [30, 4], "place": [0, 62],
        "displacement": [null, -0.2], "ramp": 500, "mass": 50, "machine_stiffness": 0.1}])"});
  const Course course = run(b, 3000);
  EXPECT_LT(course.residual / course.work, 1e-4);
  // Undamped here: about its mean.
  double force = 0, spring = 0;
  for (int n = 0; n < 4000; ++n) {
    b.step();
    const auto r = b.body.tools->read(0);
    force += r.force[1];
    spring += 0.1 * (-0.2 - r.displacement[1]);
  }
  EXPECT_NEAR(force / spring, 1, 1e-2);
}
} // namespace
