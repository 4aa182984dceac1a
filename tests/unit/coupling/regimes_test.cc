// The overlap at large rotation and finite strain: one energy, whose derivative are the forces.
#include "core/extremes.h"
#include "particles/orientation.h"
#include "tests/support/energy_slope.h"
#include "tests/support/stiffening_law.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace ligament
{
namespace
{
using namespace tests;
using coupling::Regime;

template <int dim>
using Matrix = Eigen::Matrix<double, dim, dim>;

template <int dim>
CoupledBodiesParameters<dim> small_body(double nu, bool has_hanging_nodes = false)
{
  CoupledBodiesParameters<dim> p;
  p.material.poissons_ratio = nu;
  p.split.fine_damper = p.split.gap_filter = 0;
  p.transition_cells = 2;
  if constexpr (dim == 2) {
    p.size = {70, 66};
    p.zone_size = {38, 34};
    p.overlap_cells = 2;
  } else {
    p.size = {9.3, 8.7, 50};
    p.zone_size = {100, 100, 25};
    p.cell_size = 3.1;
    p.overlap_cells = 2;
  }
  if (has_hanging_nodes) {
    p.cell_size = 2.6;
    p.overlap_cells = 4;
    p.levels = p.fine_cells = 1;
  }
  return p;
}

Matrix<2> rotation_2d(double angle)
{
  return Eigen::Rotation2Dd(angle).toRotationMatrix();
}

template <int dim>
Matrix<dim> some_rotation(double angle)
{
  if constexpr (dim == 2)
    return rotation_2d(angle);
  else
    return Eigen::AngleAxisd(angle, Vector<3>(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
}

/// Everything moves as x = R S X.
template <int dim>
void move(CoupledBodies<dim> &body, const Matrix<dim> &rotation, const Matrix<dim> &stretch)
{
  const Matrix<dim> h = rotation * stretch - Matrix<dim>::Identity();
  auto &zone = body.zone->state;
  for (int i = 0; i < zone.size(); ++i) {
    set(zone.displacement, i, Vector<dim>(h * get(zone.reference, i)));
    particles::set_orientation<dim>(zone, i, rotation);
  }
  for (int i = 0; i < body.far->mesh().n_nodes(); ++i)
    set(body.far->displacement, i, Vector<dim>(h * body.far->mesh().nodes[i]));
  auto bodies = body.bodies();
  body.split->take_velocities(bodies);
}

template <int dim>
void expect_gradient(Regime regime, double stiffening = 0, bool has_hanging_nodes = false)
{
  auto p = small_body<dim>(0.3, has_hanging_nodes);
  if (stiffening > 0)
    p.replace_law = [&](const auto &state, auto law) {
      return std::make_unique<StiffeningLaw<dim>>(state, std::move(law), stiffening);
    };
  auto body = make_coupled_bodies(p);
  auto bodies = body.bodies();
  body.split->set_regime(regime, bodies);
  Matrix<dim> stretch = Matrix<dim>::Identity();
  stretch(0, 0) = 1.03;
  stretch(0, 1) = stretch(1, 0) = -0.02;
  move<dim>(body, some_rotation<dim>(1.1), stretch);
  // Central differences: error of second order in the path, which noise of speed 1 makes 1e-6 long.
  EXPECT_NEAR(power_error(body), 0, 1e-6) << name_of(regime);
}

TEST(Regimes, ForcesAreTheGradientOfTheEnergy)
{
  for (const Regime regime : {Regime::corotated, Regime::nonlinear})
    expect_gradient<2>(regime);
}

TEST(Regimes, ForcesAreTheGradientOfTheEnergyWithHangingNodes)
{
  for (const Regime regime : {Regime::corotated, Regime::nonlinear})
    expect_gradient<2>(regime, 0, true);
}

TEST(Regimes, ForcesAreTheGradientOfTheEnergyIn3D)
{
  for (const Regime regime : {Regime::corotated, Regime::nonlinear})
    expect_gradient<3>(regime);
}

// At strains of 3 % stiffening by 2000 multiplies a bond's stiffness by about 5.
TEST(Regimes, ForcesAreTheGradientOfTheEnergyOfAStronglyNonlinearLaw)
{
  expect_gradient<2>(Regime::nonlinear, 2000);
}

// Finite noise in a strongly nonlinear law: no part of the energy is linear any more, and what is
// subtracted is not what the set-up saw. The mean energy of the last fifth of the run is that of
// the first but for the leap-frog's error, which is of second order: (omega dt)^2/24 at a tenth of
// the critical step is 2e-3 for the fastest motion, much less for the mean one.
TEST(Regimes, FiniteNoiseOfAStronglyNonlinearLawKeepsItsEnergy)
{
  auto p = small_body<2>(0.3);
  p.size = {50, 46};
  p.zone_size = {32, 28};
  p.cell_size = 3.1;
  p.step_fraction = 0.1;
  p.replace_law = [](const auto &state, auto law) {
    return std::make_unique<StiffeningLaw<2>>(state, std::move(law), 2000);
  };
  auto body = make_coupled_bodies(p);
  auto bodies = body.bodies();
  body.split->set_regime(Regime::nonlinear, bodies);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1e-2, 1e-2);
  for (auto *components : {&body.zone->state.velocity, &body.far->velocity})
    for (auto &component : *components)
      for (double &v : component)
        v = uniform(random);
  body.split->take_velocities(bodies);
  coupling::StepTime step;
  step.dt = body.dt;
  constexpr int n_steps = 1500;
  double first = 0, last = 0;
  for (; step.step < n_steps; ++step.step) {
    body.split->compute_forces(bodies, step);
    const auto e = body.split->energy(bodies, step);
    const double sum =
        e.kinetic_discrete + e.kinetic_far + e.potential_discrete + e.potential_far + e.blended;
    if (step.step < n_steps / 5)
      first += sum;
    else if (step.step >= n_steps - n_steps / 5)
      last += sum;
    body.split->kick(bodies, step);
    body.split->drift(bodies, step);
  }
  EXPECT_NEAR(last / first, 1, 1e-4);
}

/// Largest distance of the energy from its start, over that, while waves of four cells' length and
/// strains of some per cent run about in a law that stiffens.
double wandering_of_waves(int step_ratio)
{
  auto p = small_body<2>(0.3);
  p.size = {50, 46};
  p.zone_size = {32, 28};
  p.cell_size = 3.1;
  p.step_fraction = 0.1;
  p.split.step_ratio = step_ratio;
  p.replace_law = [](const auto &state, auto law) {
    return std::make_unique<StiffeningLaw<2>>(state, std::move(law), 500);
  };
  auto body = make_coupled_bodies(p);
  auto bodies = body.bodies();
  body.split->set_regime(Regime::nonlinear, bodies);
  const auto velocity = [&](const Vector<2> &x) { // over wave speeds of about 1: strains
    const Vector<2> phase = 2 * M_PI / (4 * p.cell_size) * x;
    return Vector<2>(0.02 * std::sin(phase[0]) * std::cos(phase[1]),
                     0.02 * std::sin(phase[0] + phase[1]));
  };
  auto &zone = body.zone->state;
  for (int i = 0; i < zone.size(); ++i)
    set(zone.velocity, i, velocity(get(zone.reference, i)));
  for (int i = 0; i < body.far->mesh().n_nodes(); ++i)
    set(body.far->velocity, i, velocity(body.far->mesh().nodes[i]));
  body.split->take_velocities(bodies);
  coupling::StepTime step;
  step.dt = body.dt;
  double start = 0, wandering = 0;
  for (; step.step < 2000; ++step.step) {
    body.split->compute_forces(bodies, step);
    if (step.step % 4 == 0) {
      const auto e = body.split->energy(bodies, step);
      const double sum = e.kinetic_discrete + e.kinetic_far + e.potential_discrete +
                         e.potential_far + e.blended + e.impulses;
      start = step.step == 0 ? sum : start;
      keep_largest(wandering, std::abs(sum / start - 1));
    }
    body.split->kick(bodies, step);
    body.split->drift(bodies, step);
  }
  return wandering;
}

// What the nonlinear regime adds acts with the far field's impulse. Its energies at the impulses
// wander no more than with one step per far step: an impulse of other than m forces would do so by
// its share of the energy, some 1e-2.
TEST(Regimes, FarStepsOfANonlinearOverlapBookTheirImpulses)
{
  const double each = wandering_of_waves(1), four = wandering_of_waves(4);
  EXPECT_LT(four, 3 * each);
  EXPECT_LT(each, 1e-3);
  std::printf("the energy of waves wanders by %.1e, with four steps per far step by %.1e\n", each,
              four);
}

/// Largest force on a near node or free particle, from one kick at rest.
template <int dim>
double largest_near_force(CoupledBodies<dim> &body)
{
  auto bodies = body.bodies();
  coupling::StepTime step;
  step.dt = 1;
  body.split->compute_forces(bodies, step);
  body.split->kick(bodies, step);
  const auto &near = body.split->overlap()->near_nodes;
  Eigen::MatrixXd v(near.size(), dim);
  for (std::size_t i = 0; i < near.size(); ++i)
    v.row(i) = get(body.far->velocity, near[i]).transpose();
  const Eigen::MatrixXd force = body.split->near_mass() * v;
  return force.rowwise().norm().maxCoeff();
}

/// Residual of a turned and strained body over C11 h^(dim-1), and its energy over C11 V.
template <int dim>
std::pair<double, double> turned(Regime regime, const Matrix<dim> &strain,
                                 bool has_hanging_nodes = false)
{
  auto body = make_coupled_bodies(small_body<dim>(0.3, has_hanging_nodes));
  auto bodies = body.bodies();
  body.split->set_regime(regime, bodies);
  const double c11 = body.zone->force->elastic_constants().stiffness(0, 0);
  move<dim>(body, some_rotation<dim>(M_PI / 2), Matrix<dim>::Identity() + strain);
  const double energy = potential(body, {}) / (c11 * small_body<dim>(0.3).size.prod());
  const double h = body.split->overlap()->cell_size;
  return {largest_near_force(body) / (c11 * std::pow(h, dim - 1)), energy};
}

TEST(Regimes, RotationLeavesNoForceAndNoEnergy)
{
  const auto expect_nothing = [](const std::pair<double, double> &felt) {
    EXPECT_LT(felt.first, 1e-12);
    EXPECT_LT(std::abs(felt.second), 1e-12);
  };
  for (const Regime regime : {Regime::corotated, Regime::nonlinear}) {
    expect_nothing(turned<2>(regime, Matrix<2>::Zero()));
    expect_nothing(turned<2>(regime, Matrix<2>::Zero(), true));
    expect_nothing(turned<3>(regime, Matrix<3>::Zero()));
  }
}

// All terms are linear in S - 1 but the torques of pads and of weighted terms, which the tangent of
// the polar rotation hands over with 1/tr S in place of 1/2: half the strain of what the patch fit
// removes, which is below 2e-2.
TEST(Regimes, UniformStrainOfATurnedBodyLeavesForcesOfSecondOrder)
{
  Matrix<2> e;
  e << 0.8, 0.3, 0.3, -0.5;
  for (const Regime regime : {Regime::corotated, Regime::nonlinear})
    for (const double size : {1e-5, 0.05})
      for (const bool has_hanging_nodes : {false, true})
        EXPECT_LT(turned<2>(regime, size * e, has_hanging_nodes).first, 1e-2 * size * size)
            << name_of(regime);
}
} // namespace
} // namespace ligament
