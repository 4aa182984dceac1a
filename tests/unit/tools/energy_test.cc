// Ledger and momentum of bodies that tools push, hit and leave.
#include "core/extremes.h"
#include "tests/support/tool_body.h"

#include <fmt/format.h>

#include <numeric>

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
    keep_largest(course.residual, std::abs(course.last.residual()));
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

// A tool over the corner of a held side pushes held nodes, too: their support bears that. All
// forces on the nodes but those of cells are the support's and the tool's; a support that moves, or
// one that rests while the tool moves, does the work of all of it.
template <int dim>
void expect_support_of_held_nodes(const BodyKind &kind, bool support_moves)
{
  SCOPED_TRACE(
      fmt::format("{} in {}D, {} moves", kind.name, dim, support_moves ? "support" : "tool"));
  const double half = dim == 2 ? 12 : 4, end = dim == 2 ? 60 : 30;
  const char *way = dim == 2 ? "[{}, 0]" : "[{}, 0, null]";
  ToolBody<dim> b(
      kind.overrides +
      std::vector<std::string>{
          fmt::format(R"(/loads=[{{"boundary": "bottom", "displacement": {}, "ramp": 200}}])",
                      fmt::format(way, support_moves ? 0.2 : 0)),
          fmt::format(R"(/tools=[{{"name": "plate", "shape": "plate", "size": [4, 12{}],
        "place": [{}, {}{}], "displacement": [{}, null{}], "ramp": 200}}])",
                      dim == 2 ? "" : ", 20", half + 2, -end, dim == 2 ? "" : ", 0",
                      support_moves ? 0 : -0.2, dim == 2 ? "" : ", null"),
          "/time/duration=400"});
  const Course course = run(b, 300);
  EXPECT_GT(course.area, 0);
  EXPECT_LT(course.residual / course.work, 1e-4);
  if (kind.name != std::string("pure_fem"))
    return;
  const auto &far = *b.body.far;
  Vector<dim> nodes = Vector<dim>::Zero();
  for (int c = 0; c < dim; ++c)
    nodes[c] = std::accumulate(far.force[c].begin(), far.force[c].end(), 0.);
  const Vector<dim> tool = b.body.tools->read(0).force, support = far.reaction(0);
  EXPECT_GT(tool.norm(), 0);
  EXPECT_NEAR((support + tool - nodes).norm(), 0, 1e-9 * tool.norm());
}

TEST(ToolEnergy, SupportsBearWhatAToolPushesOfThem)
{
  for (const auto &kind : kinds)
    for (const bool support_moves : {false, true})
      if (kind.name != std::string("pure_dem")) // its sides hold particles by their faces
        expect_support_of_held_nodes<2>(kind, support_moves);
  for (const bool support_moves : {false, true})
    expect_support_of_held_nodes<3>(kinds[3], support_moves);
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

// Of a drive that is at its end from the start, the spring alone has taken work in the first step.
TEST(ToolEnergy, ADriveWithoutARampStretchesItsSpring)
{
  ToolBody<2> b({"/far_field=none", "/loads=[{\"boundary\": \"bottom\", \"displacement\": [0, 0]}]",
                 R"(/tools=[{"name": "plate", "shape": "plate", "size": [30, 4], "place": [0, 80],
        "displacement": [null, -0.2], "mass": 50, "machine_stiffness": 0.1}])"});
  b.step();
  const double energy = 0.1 * 0.2 * 0.2 / 2;
  EXPECT_NEAR(b.ledger().external_work, energy, 1e-6 * energy);
  EXPECT_NEAR(b.ledger().tools.spring + b.ledger().tools.kinetic, energy, 1e-3 * energy);
}
} // namespace
