// The coupler's set-up and step on small bodies.
#include "tests/support/noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace ligament
{
namespace
{
using namespace tests;

template <int dim>
CoupledBodiesParameters<dim> band(double nu)
{
  CoupledBodiesParameters<dim> p;
  p.material.poissons_ratio = nu;
  if constexpr (dim == 2) {
    p.size = {61, 140};
    p.zone_size = {100, 50};
  } else {
    p.size = {13, 11, 90};
    p.zone_size = {100, 100, 34};
    p.cell_size = 3.1;
  }
  return p;
}

TEST(FineScaleSplit, PatchFitOfABandThatEndsAtFreeEdges)
{
  for (const double nu : {0., 0.22, 0.45})
    for (const PlaneMode plane : {PlaneMode::strain, PlaneMode::stress}) {
      auto p = band<2>(nu);
      p.material.plane = plane;
      const auto body = make_coupled_bodies(p);
      const auto &report = body.split->report();
      EXPECT_LT(report.patch_residual, 1e-12) << "nu " << nu;
      EXPECT_LT(report.patch_modulus, 0.02);
    }
}

/// Free sides are free whatever their name, also where the cells at the zone's edge are so narrow
/// that no particle lies in the outermost ones.
template <int dim>
void check_sides_without_numbers(CoupledBodiesParameters<dim> p, int axis)
{
  const auto plain = make_coupled_bodies(p).split->report();
  EXPECT_LT(plain.patch_modulus, 0.02);
  for (const int boundary : {inner_surface<dim>, inner_surface<dim> + 1}) {
    p.change_mesh = [=](fem::Mesh<dim> &mesh) {
      for (auto &face : mesh.boundary_faces)
        if (face.boundary < inner_surface<dim> && face.boundary / 2 == axis)
          face.boundary = boundary;
    };
    const auto report = make_coupled_bodies(p).split->report();
    EXPECT_NEAR(report.patch_residual_before / plain.patch_residual_before, 1, 1e-6) << boundary;
    EXPECT_NEAR(report.patch_modulus / plain.patch_modulus, 1, 1e-6) << boundary;
    EXPECT_LT(report.patch_residual, 1e-12);
  }
}

TEST(FineScaleSplit, SidesOfAnyNameAreFree)
{
  for (const double width : {26., 26.4, 26.8, 27.2}) {
    CoupledBodiesParameters<2> p;
    p.material.poissons_ratio = 0.3;
    p.size = {100, 24};
    p.zone_size = {width, 100};
    p.transition_cells = 4;
    check_sides_without_numbers(p, 1);
  }
  for (const double width : {33.4, 34.}) {
    auto p = band<3>(0.3);
    p.zone_size[2] = width;
    check_sides_without_numbers(p, 1);
  }
}

// (C6): consistent in the overlap, then linearly to lumped; at most 0.75 in cells below 2.5 d.
TEST(FineScaleSplit, ShareOfTheConsistentMass)
{
  for (const double h : {4.1, 2.3}) {
    auto p = band<2>(0.22);
    p.cell_size = h;
    p.transition_cells = 3;
    const auto body = make_coupled_bodies(p);
    const double most = h < 2.5 ? 0.75 : 1;
    const std::array<double, 4> share = {most, std::min(most, 5. / 6), 1. / 2, 1. / 6};
    for (const auto &cell : body.split->overlap()->cells)
      EXPECT_DOUBLE_EQ(cell.consistent_share, share[cell.layer]);
  }
}

TEST(FineScaleSplit, PatchFitOfABandIn3D)
{
  for (const double nu : {0., 0.3}) {
    const auto body = make_coupled_bodies(band<3>(nu));
    const auto &report = body.split->report();
    EXPECT_LT(report.patch_residual, 1e-12) << "nu " << nu;
    EXPECT_LT(report.patch_modulus, 0.02);
  }
}

TEST(FineScaleSplit, PatchFitOfAClosedRing)
{
  for (const double nu : {0., 0.22, 0.45}) {
    auto p = band<2>(nu);
    p.size = {150, 140};
    p.zone_size = {51, 47};
    const auto body = make_coupled_bodies(p);
    const auto &report = body.split->report();
    EXPECT_LT(report.patch_residual, 1e-12) << "nu " << nu;
    EXPECT_LT(report.patch_modulus, 0.02);
  }
}

CoupledBodiesParameters<2> noisy_band()
{
  auto p = band<2>(0.22);
  p.size = {31, 120};
  p.zone_size = {100, 34};
  return p;
}

// At strains of 1e-9 the body is linear to 1e-9, and the invariant of a linear body is exact.
TEST(FineScaleSplit, NoiseKeepsItsEnergy)
{
  EXPECT_LT(std::abs(drift_of_noise(noisy_band(), 1e-9, 2000)), 1e-9);
}

TEST(SlowFineScaleSplit, NoiseKeepsItsEnergy)
{
  EXPECT_LT(std::abs(drift_of_noise(noisy_band(), 1e-9, 100000)), 1e-9);
}

// With several fine steps per step of the far field the energy fluctuates, but has no trend.
TEST(FineScaleSplit, NoiseKeepsItsEnergyWithAStepRatio)
{
  auto p = noisy_band();
  p.split.step_ratio = 3;
  EXPECT_LT(std::abs(drift_of_noise(p, 1e-9, 6000)), 1e-3);
}

// What the dampers book is what is lost: the ledger (E2) with (E3) closes as without dampers.
TEST(FineScaleSplit, DampersBookWhatTheyTake)
{
  auto body = make_coupled_bodies(noisy_band());
  auto bodies = body.bodies();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1e-9, 1e-9);
  for (auto &component : body.zone->state.velocity)
    for (double &v : component)
      v = uniform(random);
  body.split->take_velocities(bodies);
  coupling::StepTime time;
  time.dt = body.dt;
  const auto energy = [&] {
    body.split->compute_forces(bodies, time);
    return body.split->energy(bodies, time);
  };
  const auto total = [](const coupling::CoupledEnergy &e) {
    return e.kinetic_discrete + e.kinetic_far + e.potential_discrete + e.potential_far + e.blended +
           e.fine_damper + e.gap_filter;
  };
  const double start = total(energy());
  for (int k = 0; k < 300; ++k)
    advance(body, time);
  const auto end = energy();
  EXPECT_GT(end.fine_damper, 0.01 * start);
  EXPECT_GT(end.gap_filter, 0);
  EXPECT_NEAR(total(end), start, 1e-9 * start);
}

// Near the critical step, where nearly incompressible packings have their highest modes anywhere:
// every step takes energy, and just what is booked, however strong the damper.
TEST(FineScaleSplit, TheDamperTakesEnergyNearTheCriticalStep)
{
  for (const double damper : {8., 100.}) {
    auto p = band<2>(0.49);
    p.kind = packings::LatticeKind::square;
    p.size = {21, 94};
    p.zone_size = {100, 34};
    p.transition_cells = 2;
    p.step_fraction = 0.95;
    p.split.fine_damper = damper;
    p.split.gap_filter = 0;
    auto body = make_coupled_bodies(p);
    auto bodies = body.bodies();
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1e-9, 1e-9);
    for (auto &v : body.zone->state.velocity)
      for (double &value : v)
        value = uniform(random);
    body.split->take_velocities(bodies);
    coupling::StepTime time;
    time.dt = body.dt;
    double before = 0, last = 0;
    for (int k = 0; k < 100; ++k) {
      body.split->compute_forces(bodies, time);
      const auto e = body.split->energy(bodies, time);
      const double now =
          e.kinetic_discrete + e.kinetic_far + e.potential_discrete + e.potential_far + e.blended;
      if (k == 0)
        before = now;
      else
        ASSERT_LT(now, last) << "step " << k;
      EXPECT_NEAR((now + e.fine_damper) / before, 1, 1e-9);
      last = now;
      body.split->kick(bodies, time);
      body.split->drift(bodies, time);
      ++time.step;
      time.time += time.dt;
    }
  }
}
} // namespace
} // namespace ligament
