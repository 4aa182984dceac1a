// A force with a range whose bonds bear forces in the reference, coupled to the mesh: a crystal.
#include "core/extremes.h"
#include "tests/support/crystal_strip.h"
#include "tests/support/energy_slope.h"
#include "tests/support/noise.h"

#include <gtest/gtest.h>

namespace ligament
{
namespace
{
using namespace tests;
using coupling::Regime;

template <int dim>
using Matrix = Eigen::Matrix<double, dim, dim>;

// Forces cancel to round-off of a few dozen bonds, the body moves by up to its own half size 40 in
// a unit gradient: 1e-14 of a cell's force per round-off of a place.
constexpr double round_off = 1e-13;

template <int dim>
void expect_every_gradient(const CrystalParameters<dim> &p, double tolerance)
{
  auto body = make_crystal(p);
  EXPECT_LT(free_force(body), round_off);
  const auto &report = body.split->report();
  const auto place = testing::Message() << dim << "D, turned by " << p.turn << ", strain "
                                        << p.strain << ", reach " << p.reach;
  EXPECT_LT(report.patch_residual, tolerance) << place;
  EXPECT_LT(report.patch_modulus, 0.02) << place;
  const double reference = reference_residual(body), gradient = gradient_residual(body);
  EXPECT_LT(reference, tolerance) << place;
  EXPECT_LT(gradient, tolerance) << place;
  std::printf("%s: fit %.1e before, %.1e after, modulus %.1e; reference %.1e, gradients %.1e; "
              "pads %.2f deep\n",
              place.GetString().c_str(), report.patch_residual_before, report.patch_residual,
              report.patch_modulus, reference, gradient, body.split->overlap()->depth);
}

template <int dim>
CrystalParameters<dim> crystal(double turn, double strain = 0)
{
  CrystalParameters<dim> p;
  p.turn = turn;
  p.strain = strain;
  return p;
}

TEST(Crystal, EveryDisplacementGradientIsCarried)
{
  for (const double turn : {0., 0.4})
    expect_every_gradient(crystal<2>(turn), round_off);
  auto three_shells = crystal<2>(0.4);
  three_shells.reach = 2.2;
  expect_every_gradient(three_shells, round_off);
}

TEST(Crystal, EveryDisplacementGradientIsCarriedUnderStress)
{
  for (const double strain : {0.02, -0.02})
    expect_every_gradient(crystal<2>(0.4, strain), 1e-12);
}

TEST(Crystal, EveryDisplacementGradientIsCarriedIn3D)
{
  expect_every_gradient(crystal<3>(0.4), round_off);
}

TEST(SlowCrystal, EveryDisplacementGradientIsCarriedIn3D)
{
  expect_every_gradient(crystal<3>(0), round_off);
  for (const double strain : {0.02, -0.02})
    expect_every_gradient(crystal<3>(0.4, strain), 1e-12);
}

// A turned body is at rest: the dead load turns with it, and it has no energy.
template <int dim>
void expect_rest_when_turned(double strain)
{
  auto p = crystal<dim>(0.4, strain);
  p.is_harmonic = false;
  auto body = make_crystal(p);
  auto bodies = body.bodies();
  body.split->set_regime(Regime::corotated, bodies);
  Matrix<dim> turn = Matrix<dim>::Identity();
  turn.template topLeftCorner<2, 2>() = Eigen::Rotation2Dd(1.3).toRotationMatrix();
  if constexpr (dim == 3)
    turn = Eigen::AngleAxisd(1.3, Vector<3>(0.2, 0.9, -0.4).normalized()).toRotationMatrix();
  move_by_gradient<dim>(body, turn - Matrix<dim>::Identity());
  const double c11 = body.far->body().stiffness(0, 0);
  const double force = overlap_forces(body).rowwise().norm().maxCoeff() / force_scale(body);
  EXPECT_LT(force, 1e-12) << dim << "D, strain " << strain;
  double free = 0; // on atoms outside the overlap that see all neighbours
  for (int i = 0; i < body.zone->state.size(); ++i)
    if (body.split->overlap()->member_of_particle[i] < 0)
      keep_largest(free, get(body.zone->state.force, i).norm());
  EXPECT_LT(free, 1e-12 * c11);
  EXPECT_LT(std::abs(potential(body, {})), 1e-12 * c11 * p.size.prod());
  std::printf("%dD turned, strain %.2f: force %.1e, free atoms %.1e, energy %.1e\n", dim, strain,
              force, free / c11, potential(body, {}) / (c11 * p.size.prod()));
}

TEST(Crystal, ATurnedBodyIsAtRest)
{
  for (const double strain : {0., 0.02})
    expect_rest_when_turned<2>(strain);
  expect_rest_when_turned<3>(0);
}

// Of atoms that bear finite strain, with the dead load of a stressed crystal in the sum. Central
// differences: error of second order in the path, which noise of speed 1 makes 1e-6 long.
TEST(Crystal, ForcesAreTheSlopeOfTheEnergy)
{
  for (const Regime regime : {Regime::linear, Regime::corotated}) {
    auto p = crystal<2>(0.4, 0.02);
    p.is_harmonic = false;
    auto body = make_crystal(p);
    auto bodies = body.bodies();
    body.split->set_regime(regime, bodies);
    Matrix<2> h;
    h << 0.02, -0.01, 0.03, -0.01;
    if (regime == Regime::corotated)
      h = Eigen::Rotation2Dd(1.1).toRotationMatrix() * (Matrix<2>::Identity() + h) -
          Matrix<2>::Identity();
    move_by_gradient<2>(body, h);
    EXPECT_NEAR(power_error(body), 0, 1e-6) << name_of(regime);
  }
}

/// Smaller than the box of the patch tests.
CrystalParameters<2> noisy_crystal(double strain = 0)
{
  auto p = crystal<2>(0.4, strain);
  p.cell_size = 3.1;
  p.size = {56, 55};
  p.zone_size = {29.2, 28.7};
  return p;
}

// The harmonic crystal is linear: its invariant is exact, and (C1) leaves no way to pump.
TEST(Crystal, NoiseKeepsItsEnergy)
{
  EXPECT_LT(std::abs(drift_of_noise(make_crystal(noisy_crystal()), 1, 2000)), 1e-11);
  EXPECT_LT(std::abs(drift_of_noise(make_crystal(noisy_crystal(0.02)), 1, 2000)), 1e-11);
}

TEST(SlowCrystal, NoiseKeepsItsEnergy)
{
  const double drift = drift_of_noise(make_crystal(noisy_crystal()), 1, 100000);
  EXPECT_LT(std::abs(drift), 1e-9);
  std::printf("drift %.1e\n", drift);
}

// Noise in a step that is beyond the critical one by 1e-4 grows by 1 + sqrt(8e-4) in each of them.
// Sides are held: under pressure a free body turns over, whatever the step.
TEST(Crystal, CriticalStepIsThatOfThePlainCrystal)
{
  for (const double strain : {0., 0.02, -0.02}) {
    auto p = noisy_crystal(strain);
    p.holds_sides = true;
    p.step_fraction = 0.999;
    EXPECT_LT(std::abs(drift_of_noise(make_crystal(p), 1, 3000)), 1e-6) << strain;
    p.step_fraction = 1.01; // of which the plain crystal itself knows
    EXPECT_FALSE(std::abs(drift_of_noise(make_crystal(p), 1, 3000)) < 1) << strain;
  }
}

/// Largest 1 - a of a term that some members of the overlap enter, but not all of its particles.
double largest_torn_share(CrystalFaults faults)
{
  auto p = crystal<2>(0.4);
  p.faults = faults;
  const auto body = make_crystal(p);
  const auto &overlap = *body.split->overlap();
  double largest = 0;
  body.zone->force->add_tangent(body.zone->state, [&](const particles::QuadraticTerm<2> &term) {
    const auto n = std::count_if(term.members.begin(), term.members.end(),
                                 [&](int i) { return overlap.member_of_particle[i] >= 0; });
    if (n > 0 && n < long(term.members.size()))
      keep_largest(largest, 1 - overlap.weight(term.location));
  });
  return largest;
}

// Nothing is subtracted of a term that leaves the mesh, so all of it must count.
TEST(Crystal, TermsThatLeaveTheMeshAreWhole)
{
  EXPECT_EQ(largest_torn_share({}), 0);
  CrystalFaults margin;
  margin.hides_range = true;
  EXPECT_GT(largest_torn_share(margin), 1e-4);
}

// Every question that a force may answer wrongly shows: in what is left on nodes and free atoms, or
// in what the fit has to mend. In a strip no corner hides that.
TEST(Crystal, WrongAnswersShow)
{
  struct Figures
  {
    double reference, free, gradient;
  };
  const auto box = [](double strain, CrystalFaults faults) {
    auto p = crystal<2>(0.4, strain);
    p.faults = faults;
    auto body = make_crystal(p);
    const Figures f = {reference_residual(body), free_force(body), gradient_residual(body)};
    std::printf("  strain %.2f: reference %.1e, free atoms %.1e, gradients %.1e\n", strain,
                f.reference, f.free, f.gradient);
    return f;
  };
  const auto before_fit = [](CrystalFaults faults, bool is_normal, int overlap_cells) {
    CrystalParameters<2> p;
    p.faults = faults;
    p.is_normal = is_normal;
    p.overlap_cells = overlap_cells;
    const CrystalStrip<2> strip(p, 10, 40, 0);
    const auto &report = strip.body.split->report();
    std::printf("  strip: before %.1e, fit %.1e, modulus %.1e\n", report.patch_residual_before,
                report.patch_residual, report.patch_modulus);
    return report.patch_residual_before;
  };
  CrystalFaults no_load, at_atoms, strains_alone, faces;
  no_load.hides_reference = at_atoms.embeds_at_atoms = strains_alone.hides_prestress =
      faces.closes_by_faces = true;
  EXPECT_GT(box(0, no_load).reference, 1e-6);
  EXPECT_GT(box(0.02, strains_alone).gradient, 1e-6);
  EXPECT_GT(box(0, faces).free, 1e-6);
  const double right = before_fit({}, true, 4);
  EXPECT_LT(right, 1e-2);
  EXPECT_NEAR(before_fit({}, false, 4) / right, 1, 1e-9); // the terms know no form
  const double right_6 = before_fit({}, true, 6);
  EXPECT_NEAR(before_fit(at_atoms, true, 6) / right_6, 1, 1e-9); // F' = 0 but at the edge
  EXPECT_GT(before_fit(at_atoms, false, 6), 1.5 * right_6);
}

TEST(SlowCrystal, WavesLeave)
{
  for (const double length : {16., 8., 4.})
    for (const int polarisation : {1, 0}) {
      const double share = reflected_share<2>(length, polarisation);
      std::printf("2D %c %gh: %.1e\n", polarisation == 1 ? 'P' : 'S', length, share);
      EXPECT_LT(share, length == 4 ? 5e-3 : 1e-4);
    }
}

void expect_refusal(const CrystalParameters<2> &p, const std::string &word)
{
  try {
    make_crystal(p);
    ADD_FAILURE() << "not refused: " << word;
  } catch (const core::InputError &error) {
    EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
  }
}

TEST(Crystal, WhatItCantDoIsRefused)
{
  auto thin = crystal<2>(0.4);
  thin.overlap_cells = 3;
  expect_refusal(thin, "raise /coupling/overlap_cells to 4");
  auto band = crystal<2>(0.4);
  band.size[0] = band.zone_size[0];
  expect_refusal(band, "free surface");
  auto body = make_crystal(crystal<2>(0.4));
  auto bodies = body.bodies();
  EXPECT_THROW(body.split->set_regime(Regime::nonlinear, bodies), core::InputError);
}
} // namespace
} // namespace ligament
