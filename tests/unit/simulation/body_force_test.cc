// Forces on every mass, and bodies that begin in motion.
#include "core/extremes.h"
#include "src/simulation/energy_ledger.h"
#include "src/simulation/initial_motion.h"
#include "src/simulation/test_machine.h"
#include "tests/support/static_body.h"

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
const std::vector<BodyKind> falling_bodies = {
    {"coupled", {}},
    {"coupled, far field in every third step", {"/coupling/step_ratio=3"}},
    {"energy-weighted", {"/coupling/scheme=xiao_belytschko"}},
    {"pure_dem", {"/far_field=none"}},
    {"pure_fem", {"/discrete_zone=none"}}};

/// Calls visit(place, displacement, velocity) for all particles and nodes.
template <typename Visit>
void for_each_point(const CoupledBody<2> &body, Visit &&visit)
{
  if (body.zone)
    for (int i = 0; i < body.zone->state.size(); ++i)
      visit(get(body.zone->state.reference, i), get(body.zone->state.displacement, i),
            get(body.zone->state.velocity, i));
  if (body.far)
    for (int i = 0; i < body.far->mesh().n_nodes(); ++i)
      visit(body.far->mesh().nodes[i], get(body.far->displacement, i), get(body.far->velocity, i));
}

/// Steps to the forces of step n; `look` sees the body there.
void run(CoupledBody<2> &body, long n, const std::function<void(const coupling::StepTime &)> &look)
{
  auto bodies = body.bodies();
  coupling::StepTime step{0, 0, body.dt};
  body.coupler->compute_forces(bodies, step);
  for (; step.step < n; step = {step.step + 1, double(step.step + 1) * step.dt, step.dt}) {
    if (step.step > 0)
      body.coupler->compute_forces(bodies, step);
    if (step.step % body.coupler->step_ratio() == 0)
      look(step);
    body.coupler->kick(bodies, step);
    body.coupler->drift(bodies, step);
  }
  body.coupler->compute_forces(bodies, step);
  look(step);
}

TEST(BodyForce, AllFallAlike)
{
  const Vector<2> g(0.4e-6, -1e-6);
  for (const auto &kind : falling_bodies) {
    SCOPED_TRACE(kind.name);
    SmallBody small(
        small_scene(kind.overrides +
                    std::vector<std::string>{"/body_force={\"acceleration\": [0.4e-6, -1e-6]}"}));
    const int m = small.body.coupler->step_ratio();
    const long n = 60;
    double residual = 0, work = 0;
    run(small.body, n, [&](const coupling::StepTime &step) {
      const auto ledger = read_ledger(small.body, step, 0);
      keep_largest(residual, std::abs(ledger.residual()));
      work = ledger.external_work;
    });
    const double dt = small.body.dt, fall = n * (n + 1) / 2. * dt * dt;
    // The far field's part of the overlap comes in impulses: its points lag or lead by up to a
    // step of it, and the body shakes a little.
    const double tolerance = m == 1 ? 1e-10 : 3. * m / n;
    for_each_point(small.body, [&](const Vector<2> &, const Vector<2> &u, const Vector<2> &) {
      EXPECT_NEAR((u - fall * g).norm() / (fall * g.norm()), 0, tolerance);
    });
    const double height = 24. * 120 * g.squaredNorm() * fall;
    EXPECT_NEAR(work / height, 1, m == 1 ? 1e-2 : 0.1); // the last half step is another one
    if (m == 1) {
      EXPECT_NEAR(residual / height, 0, 1e-12);
    }
  }
}

TEST(BodyForce, ABarHangsByItsWeight)
{
  const double g = 1e-7, length = 120, modulus = 1; // plane stress
  for (const auto &kind : falling_bodies) {
    SCOPED_TRACE(kind.name);
    StaticBody<2> bar(
        kind.overrides +
        std::vector<std::string>{"/plane=stress", "/body_force={\"acceleration\": [0, -1e-7]}",
                                 R"(/loads=[{"boundary": "top", "displacement": [null, 0]},
                {"boundary": "left", "displacement": [0, null], "from": 56}])"});
    bar.solver.settle_linear(1);
    const double elongation = -mean_displacement(bar.body, 2, 1);
    // rho g L^2/(2E): free at the sides but near the top, where nothing holds it back across.
    EXPECT_NEAR(elongation / (g * length * length / (2 * modulus)), 1, 2e-3);
  }
}

TEST(InitialMotion, FreeFlightIsUniform)
{
  for (const auto &kind : falling_bodies) {
    SCOPED_TRACE(kind.name);
    const Scene scene =
        small_scene(kind.overrides +
                    std::vector<std::string>{"/initial_motion=[{\"velocity\": [3e-3, -1e-3]}]"});
    SmallBody small(scene);
    start_motion(scene, small.body);
    double first = -1;
    run(small.body, 60, [&](const coupling::StepTime &step) {
      const auto e = small.body.coupler->energy(small.body.bodies(), step);
      const double kinetic = e.kinetic_discrete + e.kinetic_far;
      if (first < 0)
        first = kinetic;
      EXPECT_NEAR(kinetic / first, 1, 1e-12);
      EXPECT_NEAR(read_ledger(small.body, step, 0).residual() / first, 0, 1e-12);
    });
    EXPECT_NEAR(first / (0.5 * 24 * 120 * 1e-5), 1, 1e-2) << "half of m v^2";
    const Vector<2> u = 60 * small.body.dt * Vector<2>(3e-3, -1e-3);
    for_each_point(small.body, [&](const Vector<2> &, const Vector<2> &moved, const Vector<2> &) {
      EXPECT_NEAR((moved - u).norm() / u.norm(), 0, 1e-11);
    });
  }
}

TEST(InitialMotion, SpinIsThatOfARigidBodyAboutItsCentre)
{
  for (const auto &kind : body_kinds) {
    SCOPED_TRACE(kind.name);
    const Scene scene = small_scene(
        kind.overrides +
        std::vector<std::string>{"/initial_motion=[{\"spin\": 2e-4, \"centre\": [3, -5]}]"});
    SmallBody small(scene);
    start_motion(scene, small.body);
    for_each_point(small.body, [&](const Vector<2> &x, const Vector<2> &, const Vector<2> &v) {
      EXPECT_NEAR((v - 2e-4 * Vector<2>(-(x[1] + 5), x[0] - 3)).norm(), 0, 1e-14);
    });
    if (small.body.zone) {
      for (const double spin : small.body.zone->state.spin[0])
        EXPECT_NEAR(spin, 2e-4, 1e-15);
    }
  }
}

// A region's edge in the overlap: particles there move with the mesh, so nothing is left to the
// fine scale, and the damper takes nothing in the first step.
TEST(InitialMotion, RegionsMoveAloneAndTheOverlapWithTheMesh)
{
  const Scene scene = small_scene({"/initial_motion=[{\"velocity\": [0, 1e-3], \"within\": "
                                   "{\"lower\": [null, -15.3], \"upper\": [null, 30]}}]"});
  SmallBody small(scene);
  start_motion(scene, small.body);
  const auto &overlap = *small.body.coupler->overlap();
  const auto &zone = small.body.zone->state;
  int n_moving = 0, n_between = 0;
  for (int i = 0; i < zone.size(); ++i) {
    const double v = zone.velocity[1][i];
    if (const int k = overlap.member_of_particle[i]; k >= 0) {
      double mesh = 0;
      for (int a = 0; a < 4; ++a)
        mesh += overlap.members[k].value[a] *
                small.body.far->velocity[1][overlap.near_nodes[overlap.members[k].nodes[a]]];
      EXPECT_NEAR(v, mesh, 1e-17);
      n_between += v > 1e-4 && v < 9e-4;
    } else
      EXPECT_EQ(v, zone.reference[1][i] >= -15.3 ? 1e-3 : 0);
    n_moving += v > 5e-4;
  }
  EXPECT_GT(n_moving, 100);
  EXPECT_GT(n_between, 5) << "over a cell the mesh goes from moving to still";
  for (int i = 0; i < small.body.far->mesh().n_nodes(); ++i) {
    const double y = small.body.far->mesh().nodes[i][1];
    EXPECT_EQ(small.body.far->velocity[1][i], y >= -15.3 && y <= 30 ? 1e-3 : 0);
  }
}
} // namespace
