// Bodies whose sides are joined in motion: momentum, energy, breaking across the sides, resuming.
#include "core/extremes.h"
#include "packings/random_packing.h"
#include "tests/unit/dem/body.h"
#include "tests/unit/dem/cases.h"

#include "particles/particle_solver.h"

#include <gtest/gtest.h>

namespace ligament::dem::testing
{
namespace
{
struct SteppedBody
{
  packings::Packing<2> packing;
  ManyBodyForce<2> *law = nullptr;
  std::unique_ptr<particles::ParticleSolver<2>> solver;
  double dt = 0;
  int step = 0;

  void go(int n)
  {
    for (const int end = step + n; step < end;) {
      solver->drift(dt);
      solver->compute_forces(++step * dt);
      solver->kick(dt);
    }
  }
};

/// Sheared by its sides, with free ones along the other axis, after a ramp in s; 0: the jump is
/// there from the start.
SteppedBody sheared_body(double jump, double strength, double friction = 0, double ramp = 0.5)
{
  packings::RandomParameters<2> p;
  p.spacing = 0.01;
  p.upper = {0.1, 0.08};
  p.periodic = {true, false};
  SteppedBody body;
  body.packing = packings::make_random_packing(p).packing;
  const DemMaterial material{1, 0.3, 1, PlaneMode::strain, friction};
  std::vector<core::BoundaryLoad<2>> loads(1);
  loads[0].boundary = core::BoundaryLoad<2>::jump_across(0);
  loads[0].value = {jump, jump / 2};
  loads[0].history = core::Ramp{ramp};
  if (ramp == 0)
    loads[0].kind = core::BoundaryLoad<2>::Kind::displacement;
  FractureLaw fracture;
  if (strength > 0) {
    fracture.criterion = FractureLaw::Criterion::maximum_tension;
    fracture.strength = strength;
  }
  auto force = std::make_unique<ManyBodyForce<2>>(body.packing, material, loads, fracture);
  body.law = force.get();
  Particles<2> state;
  packings::fill_particles(body.packing, material.density, state);
  body.dt = 0.5 * force->stable_step(state);
  body.solver = std::make_unique<particles::ParticleSolver<2>>(std::move(state), std::move(force));
  body.solver->compute_forces(0);
  body.solver->kick(body.dt / 2);
  return body;
}
} // namespace

namespace
{
void expect_momentum_and_work(double ramp)
{
  // The square of this strain is round-off: the law is linear, and the balance exact.
  auto body = sheared_body(1e-13, 0, 0, ramp);
  const auto &p = body.solver->state;
  // Half a kick of a body at rest: -1/2 and 1/2 of a step differ in sign.
  double start = 0;
  for (int i = 0; i < p.size(); ++i)
    start -= (p.mass[i] * get(p.velocity, i).squaredNorm() +
              p.inertia(i) * p.spin[0][i] * p.spin[0][i]) /
             2;
  double worst = 0, energy = 0;
  for (int k = 0; k < 100; ++k) {
    body.go(99);
    body.solver->drift(body.dt);
    body.solver->compute_forces(++body.step * body.dt);
    energy = body.solver->kinetic_energy(body.dt) + body.solver->potential_energy();
    keep_largest(worst, std::abs(energy - start - body.law->external_work()));
    body.solver->kick(body.dt);
  }
  EXPECT_GT(energy, 0);
  EXPECT_LT(worst, 1e-10 * energy);
  Vector<2> momentum = Vector<2>::Zero();
  double sum = 0;
  for (int i = 0; i < p.size(); ++i) {
    momentum += p.mass[i] * get(p.velocity, i);
    sum += p.mass[i] * get(p.velocity, i).norm();
  }
  EXPECT_GT(sum, 0);
  EXPECT_LT(momentum.norm(), 1e-10 * sum);
}
} // namespace

TEST(PeriodicRandom, MomentumStaysAndTheWorkOfTheJumpIsTheEnergy)
{
  for (const double ramp : {0.5, 0.})
    expect_momentum_and_work(ramp);
}

TEST(PeriodicRandom, ABondThatBreaksAcrossTheSidesIsFeltOnBoth)
{
  for (const double strain : {1e-4, 1e-6}) {
    auto body = sheared_body(0.1 * strain, 0.4 * strain);
    body.go(2000);
    int n_across = 0, n_all = 0;
    for (const auto &broken : body.law->broken_bonds()) {
      ++n_all;
      n_across +=
          (get(body.packing.centre, broken.i) - get(body.packing.centre, broken.j)).norm() > 0.05;
    }
    EXPECT_GT(n_all, 10);
    EXPECT_GT(n_across, 2);
    // Nothing is lost: what acts is minus the gradient, and the ledger closes.
    body.solver->drift(body.dt);
    body.solver->compute_forces(++body.step * body.dt);
    const auto losses = body.law->losses();
    const double energy = body.solver->kinetic_energy(body.dt) + body.solver->potential_energy() +
                          losses.fracture + losses.friction + losses.breaking_step_error;
    // What is booked of contacts that open and close is exact but for their turns over a step, of
    // the order of the strain.
    EXPECT_NEAR(energy, body.law->external_work(), strain * std::abs(losses.breaking_step_error));
  }
}

// A slit on both sides of the seam is closed by the jump alone: no particle moves.
TEST(PeriodicSquare, ImagesThatComeNearAreFound)
{
  auto lattice = box<Case<2, packings::LatticeKind::square, false>>(8);
  const double d = lattice.spacing, top = 4 * d;
  lattice.upper.setConstant(top);
  lattice.lower = -lattice.upper;
  lattice.periodic = {false, true};
  lattice.notches = {{{-2 * top, 2.4 * d}, {2 * top, 5.6 * d}}};
  const auto packing = packings::make_lattice_packing<2>(lattice);
  std::vector<core::BoundaryLoad<2>> loads(1);
  loads[0].boundary = core::BoundaryLoad<2>::jump_across(1);
  loads[0].value = {0, -4.5 * d}; // m/s; four rows of eight are missing
  loads[0].history = core::Ramp{1};
  ManyBodyForce<2> force(packing, DemMaterial{1, 0.3, 1}, loads);
  Particles<2> p;
  packings::fill_particles(packing, 1, p);
  for (int s = 0; s <= 75; ++s) // half a second behind the ramp
    force.compute(p, 0.02 * s);
  double lowest = 0, highest = 0;
  for (int i = 0; i < p.size(); ++i) {
    keep_smallest(lowest, p.force[1][i]);
    keep_largest(highest, p.force[1][i]);
  }
  EXPECT_GT(highest, 0); // on those above the slit's image
  EXPECT_LT(lowest, 0);
}

TEST(PeriodicRandom, ResumesToTheBit)
{
  auto whole = sheared_body(1e-3, 0.004, 0.4), first = sheared_body(1e-3, 0.004, 0.4),
       second = sheared_body(1e-3, 0.004, 0.4);
  whole.go(2400);
  first.go(2000);
  EXPECT_GT(first.law->n_contacts(), 0);
  core::State state;
  first.solver->save(state);
  second.solver->load(state);
  second.step = first.step;
  second.go(400);
  EXPECT_EQ(whole.solver->state.displacement, second.solver->state.displacement);
  EXPECT_EQ(whole.solver->state.velocity, second.solver->state.velocity);
  EXPECT_EQ(whole.law->external_work(), second.law->external_work());
  EXPECT_EQ(whole.law->broken_bonds().size(), second.law->broken_bonds().size());
}
} // namespace ligament::dem::testing
