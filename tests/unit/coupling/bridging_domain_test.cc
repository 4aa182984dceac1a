// The energy-weighted couplers of the literature on small bodies.
#include "core/extremes.h"
#include "coupling/operators/energy_weights.h"
#include "coupling/operators/fine_damper.h"
#include "tests/support/coupled_bodies.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ligament
{
namespace
{
using namespace tests;
using coupling::BridgingDomainParameters;
using coupling::Scheme;

template <int dim>
CoupledBodiesParameters<dim> weighted_band(Scheme scheme)
{
  CoupledBodiesParameters<dim> p;
  p.material.poissons_ratio = 0.22;
  p.transition_cells = 2;
  if constexpr (dim == 2) {
    p.size = {21, 84};
    p.zone_size = {100, 34};
  } else {
    p.size = {7, 6.5, 56};
    p.zone_size = {100, 100, 26};
    p.cell_size = 3.1;
  }
  p.bridging.emplace();
  p.bridging->scheme = scheme;
  p.bridging->fine_damper = 0;
  return p;
}

template <int dim>
void start_noise(CoupledBodies<dim> &body, double speed)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-speed, speed);
  const auto fill = [&](auto &components) {
    for (auto &component : components)
      for (double &v : component)
        v = uniform(random);
  };
  fill(body.zone->state.velocity);
  fill(body.far->velocity);
  body.far->distribute();
  auto bodies = body.bodies();
  body.bridging->take_velocities(bodies);
}

/// Mechanical energy, and what the damper took, after these steps.
template <int dim>
std::pair<double, double> run(CoupledBodies<dim> &body, coupling::StepTime &time, int n_steps)
{
  auto bodies = body.bodies();
  time.dt = body.dt;
  for (int k = 0; k < n_steps; ++k) {
    body.bridging->compute_forces(bodies, time);
    body.bridging->kick(bodies, time);
    body.bridging->drift(bodies, time);
    ++time.step;
    time.time += time.dt;
  }
  body.bridging->compute_forces(bodies, time);
  const auto e = body.bridging->energy(bodies, time);
  return {e.kinetic_discrete + e.kinetic_far + e.potential_discrete + e.potential_far + e.blended,
          e.fine_damper};
}

/// Largest entry of Phi^T m (v - Phi V) over that of Phi^T m |v|: what the nodal multipliers see.
template <int dim>
double largest_gap(const CoupledBodies<dim> &body)
{
  const auto &overlap = *body.bridging->overlap();
  const auto &zone = body.zone->state;
  Eigen::MatrixXd gap = Eigen::MatrixXd::Zero(overlap.n_nodes(), dim), size = gap;
  for (const auto &m : overlap.members)
    for (int c = 0; c < dim; ++c) {
      const double v = zone.velocity[c][m.particle];
      double difference = v;
      for (std::size_t a = 0; a < m.nodes.size(); ++a)
        difference -= m.value[a] * body.far->velocity[c][overlap.near_nodes[m.nodes[a]]];
      for (std::size_t a = 0; a < m.nodes.size(); ++a) {
        gap(m.nodes[a], c) += m.value[a] * zone.volume[m.particle] * difference;
        size(m.nodes[a], c) += m.value[a] * zone.volume[m.particle] * std::abs(v);
      }
    }
  return gap.cwiseAbs().maxCoeff() / size.maxCoeff();
}

template <int dim>
Vector<dim> momentum(const CoupledBodies<dim> &body)
{
  Vector<dim> sum = Vector<dim>::Zero();
  const auto &zone = body.zone->state;
  for (int i = 0; i < zone.size(); ++i)
    sum += zone.mass[i] * get(zone.velocity, i);
  const auto &overlap = *body.bridging->overlap();
  Eigen::MatrixXd near(overlap.n_nodes(), dim);
  for (int i = 0; i < overlap.n_nodes(); ++i)
    near.row(i) = get(body.far->velocity, overlap.near_nodes[i]).transpose();
  sum += (body.bridging->near_mass() * near).colwise().sum().transpose();
  for (int i = 0; i < body.far->mesh().n_nodes(); ++i)
    if (!body.far->is_released_node(i))
      sum += body.far->lumped_mass()[i] * get(body.far->velocity, i);
  return sum;
}

// At strains of 1e-9 the law is linear to 1e-9, and the invariant (E1) of the linear, constrained
// body is exact.
TEST(BridgingDomain, ProjectedAccelerationsKeepTheEnergy)
{
  for (const Scheme scheme : {Scheme::acceleration, Scheme::pointwise}) {
    auto body = make_coupled_bodies(weighted_band<2>(scheme));
    start_noise(body, 1e-9);
    coupling::StepTime time;
    const double before = run(body, time, 0).first;
    EXPECT_NEAR(run(body, time, 1000).first / before, 1, 1e-9) << int(scheme);
  }
}

TEST(BridgingDomain, ProjectedAccelerationsKeepTheEnergyIn3D)
{
  auto body = make_coupled_bodies(weighted_band<3>(Scheme::acceleration));
  start_noise(body, 1e-9);
  coupling::StepTime time;
  const double before = run(body, time, 0).first;
  EXPECT_NEAR(run(body, time, 100).first / before, 1, 1e-9);
}

TEST(BridgingDomain, VelocitiesFulfilTheConstraint)
{
  auto body = make_coupled_bodies(weighted_band<2>(Scheme::acceleration));
  start_noise(body, 1e-9);
  coupling::StepTime time;
  run(body, time, 50);
  EXPECT_LT(largest_gap(body), 1e-13);
}

// Multipliers pull particles and nodes with opposite forces.
TEST(BridgingDomain, MomentumIsKept)
{
  for (const Scheme scheme : {Scheme::acceleration, Scheme::xiao_belytschko,
                              Scheme::xiao_belytschko_lumped, Scheme::pointwise})
  {
    auto body = make_coupled_bodies(weighted_band<2>(scheme));
    start_noise(body, 1e-9);
    const Vector<2> before = momentum(body);
    coupling::StepTime time;
    run(body, time, 200);
    EXPECT_LT((momentum(body) - before).norm(), 1e-11 * before.norm()) << int(scheme);
  }
}

// The symmetrised damper books exactly what is missing; as printed it need not.
TEST(BridgingDomain, TheDamperBooksWhatItTakes)
{
  auto p = weighted_band<2>(Scheme::acceleration);
  p.bridging->fine_damper = 8;
  auto body = make_coupled_bodies(p);
  start_noise(body, 1e-9);
  coupling::StepTime time;
  const double before = run(body, time, 0).first;
  double energy = before;
  for (int k = 0; k < 20; ++k) {
    const auto [now, taken] = run(body, time, 10);
    EXPECT_LT(now, energy);
    EXPECT_NEAR((now + taken) / before, 1, 1e-9);
    energy = now;
  }
}

// Near the critical step, where nearly incompressible packings have their highest modes beside the
// edge: every step takes energy, however strong the damper, with and without a constraint that is
// fulfilled at half steps, and the damper alone takes it where corrections take none.
TEST(BridgingDomain, TheDamperTakesEnergyNearTheCriticalStep)
{
  for (const Scheme scheme :
       {Scheme::acceleration, Scheme::xiao_belytschko, Scheme::xiao_belytschko_lumped})
    for (const double damper : {8., 100.}) {
      auto p = weighted_band<2>(scheme);
      p.kind = packings::LatticeKind::square;
      p.material.poissons_ratio = 0.49;
      p.step_fraction = 0.95;
      p.bridging->fine_damper = damper;
      auto body = make_coupled_bodies(p);
      start_noise(body, 1e-9);
      coupling::StepTime time;
      const double before = run(body, time, 0).first;
      double energy = before;
      for (int k = 0; k < 100; ++k) {
        const auto [now, taken] = run(body, time, 1);
        ASSERT_LT(now, energy) << int(scheme) << " step " << k;
        energy = now;
        if (scheme == Scheme::acceleration) {
          EXPECT_NEAR((now + taken) / before, 1, 1e-9);
        }
      }
    }
}

// Of a weight that is linear over a whole cell the mean over the cell is the value at its centre,
// and weights of both models add to one: the body weighs what the specimen weighs.
TEST(BridgingDomain, WeightsShareTheMass)
{
  auto p = weighted_band<2>(Scheme::acceleration);
  p.weight = coupling::WeightShape::linear;
  const auto body = make_coupled_bodies(p);
  const auto &overlap = *body.bridging->overlap();
  const auto &zone = body.zone->state;
  double mass = body.bridging->near_mass().sum();
  for (int i = 0; i < zone.size(); ++i) {
    mass += zone.mass[i];
    const int index = overlap.member_of_particle[i];
    if (index < 0) {
      EXPECT_EQ(zone.mass[i], zone.volume[i]);
      continue;
    }
    const double s = overlap.members[index].position, side = std::abs(zone.reference[0][i]);
    const double reach = 1 / overlap.parameters.length; // of a cell, in s
    if (s > reach && s < 1 - reach && side < p.size[0] / 2 - 1) {
      EXPECT_NEAR(zone.mass[i] / zone.volume[i], overlap.members[index].weight, 1e-12);
    }
  }
  for (int i = 0; i < body.far->mesh().n_nodes(); ++i)
    if (!body.far->is_released_node(i))
      mass += body.far->lumped_mass()[i];
  // Half a particle's layer at each edge is the packing's freedom against the zone.
  EXPECT_NEAR(mass, p.size.prod(), 0.02 * p.size.prod());
}

// Weighted forces are those of an energy and have no resultant.
TEST(BridgingDomain, WeightedForcesBalance)
{
  auto body = make_coupled_bodies(weighted_band<2>(Scheme::acceleration));
  auto &zone = body.zone->state;
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-1e-3, 1e-3);
  for (auto &u : zone.displacement)
    for (double &v : u)
      v = uniform(random);
  body.zone->compute_forces(0);
  Vector<2> sum = Vector<2>::Zero();
  double size = 0;
  for (int i = 0; i < zone.size(); ++i) {
    sum += get(zone.force, i);
    size += get(zone.force, i).norm();
  }
  EXPECT_LT(sum.norm(), 1e-12 * size);
  const auto force = zone.force;
  // Minus the gradient of the energy, by central differences, at some particles of the overlap.
  for (std::size_t k = 0; k < body.bridging->overlap()->members.size(); k += 40) {
    const int i = body.bridging->overlap()->members[k].particle;
    const double step = 1e-5;
    zone.displacement[1][i] += step;
    const double above = body.zone->potential_energy();
    zone.displacement[1][i] -= 2 * step;
    const double below = body.zone->potential_energy();
    zone.displacement[1][i] += step;
    EXPECT_NEAR(-(above - below) / (2 * step), force[1][i], 1e-6 * size / zone.size());
  }
}

// theory.md eq. (B5): with a lumped mass all entries of the multipliers' matrix are positive.
TEST(BridgingDomain, RowSumsAreThoseOfALumpedMass)
{
  const auto body = make_coupled_bodies(weighted_band<2>(Scheme::xiao_belytschko_lumped));
  const Eigen::MatrixXd mass = body.bridging->near_mass();
  EXPECT_EQ((mass - Eigen::MatrixXd(mass.diagonal().asDiagonal())).norm(), 0);
}

// theory.md eq. (B6): at the state of reference, here of stress along y only, nothing moves in the
// overlap; far from it the specimen's ends do.
TEST(BridgingDomain, TheGhostForceCorrectionIsExactAtItsState)
{
  const auto largest_velocity = [](bool corrected) {
    auto p = weighted_band<2>(Scheme::acceleration);
    const double nu = p.material.poissons_ratio;
    const std::array<double, 3> strain = {-1e-12 * nu / (1 - nu), 1e-12, 0};
    if (corrected)
      p.bridging->reference_strain = strain;
    auto body = make_coupled_bodies(p);
    auto &zone = body.zone->state;
    for (int c = 0; c < 2; ++c) {
      for (int i = 0; i < zone.size(); ++i)
        zone.displacement[c][i] = strain[c] * zone.reference[c][i];
      for (int i = 0; i < body.far->mesh().n_nodes(); ++i)
        body.far->displacement[c][i] = strain[c] * body.far->mesh().nodes[i][c];
    }
    auto bodies = body.bodies();
    body.bridging->take_velocities(bodies);
    coupling::StepTime time;
    time.dt = body.dt;
    body.bridging->compute_forces(bodies, time);
    body.bridging->kick(bodies, time);
    double largest = 0;
    for (int i = 0; i < zone.size(); ++i)
      largest = std::max({largest, get(zone.velocity, i).norm(), std::abs(zone.spin[0][i])});
    for (const int node : body.bridging->overlap()->near_nodes)
      keep_largest(largest, get(body.far->velocity, node).norm());
    return largest;
  };
  EXPECT_LT(largest_velocity(true), 1e-11 * largest_velocity(false));
}

// theory.md eq. (B7): what the printed form takes, over g, is Q v, whose unweighted nodal momentum
// is none.
TEST(BridgingDomain, ThePrintedDamperActsOnTheLiteraturesFluctuation)
{
  auto p = weighted_band<2>(Scheme::acceleration);
  p.bridging->fine_damper = 8;
  p.bridging->damper_form = coupling::DamperForm::printed;
  auto body = make_coupled_bodies(p);
  start_noise(body, 1e-9);
  const auto &zone = body.zone->state;
  const auto before = zone.velocity;
  coupling::StepTime time;
  time.dt = body.dt;
  auto bodies = body.bodies();
  body.bridging->compute_forces(bodies, time); // at rest: none
  body.bridging->kick(bodies, time);
  const auto &overlap = *body.bridging->overlap();
  const double speed = body.zone->force->elastic_constants().wave_speed_p;
  Eigen::VectorXd momentum = Eigen::VectorXd::Zero(overlap.n_nodes()), size = momentum;
  for (const auto &m : overlap.members) {
    const double rate = coupling::fine_damper_rate(8, speed, overlap.cell_size, m.position);
    const double g = 1 - std::exp(-rate * time.dt);
    const double taken = before[0][m.particle] - zone.velocity[0][m.particle];
    for (std::size_t a = 0; a < m.nodes.size(); ++a) {
      // Beside particles that are not damped the fluctuation is not seen.
      const double share = g > 1e-6 ? m.value[a] * zone.volume[m.particle] / g
                                    : std::numeric_limits<double>::quiet_NaN();
      momentum[m.nodes[a]] += share * taken;
      size[m.nodes[a]] += std::abs(share * taken);
    }
  }
  int n_compared = 0;
  for (int i = 0; i < overlap.n_nodes(); ++i)
    if (overlap.is_overlap_node[i] && std::isfinite(momentum[i]) && size[i] > 0) {
      EXPECT_LT(std::abs(momentum[i]), 1e-9 * size[i]);
      ++n_compared;
    }
  EXPECT_GT(n_compared, 10);
}

// Of a constant weight too no more belongs to the discrete model than there are particles.
TEST(BridgingDomain, ConstantWeightsEndWithThePacking)
{
  auto p = weighted_band<2>(Scheme::acceleration);
  p.weight = coupling::WeightShape::constant;
  const auto body = make_coupled_bodies(p);
  const auto &overlap = *body.bridging->overlap();
  const double edge = p.zone_size[1] / 2 - overlap.depth;
  EXPECT_EQ(overlap.weight({0, edge - 0.01}), 0.5);
  EXPECT_EQ(overlap.weight({0, edge + 0.01}), 0);
  EXPECT_EQ(overlap.weight({0, 0}), 1);
}
} // namespace
} // namespace ligament
