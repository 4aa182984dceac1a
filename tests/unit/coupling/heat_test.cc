// The heat bath of the overlap: its stationary covariance, what it does to a harmonic crystal, and
// that it is part of a run's state.
#include "core/extremes.h"
#include "coupling/heated_particles.h"
#include "tests/support/crystal_strip.h"

#include <gtest/gtest.h>

#include <Eigen/QR>

#include <numeric>

namespace ligament
{
namespace
{
using namespace tests;
using Dense = Eigen::MatrixXd;

constexpr double thermal_energy = 1e-6; // the harmonic crystal knows no large or small
constexpr double share_of_step = 0.1;   // of the critical one
// Velocities half a step after the force have kT/(1 - (omega dt/2)^2) in each mode.
constexpr double warmest = 1 / (1 - share_of_step * share_of_step);

/// The step's matrices on the members that are not pad, one component.
struct DenseBath
{
  std::vector<int> particles;
  Eigen::VectorXd mass, kept;
  Dense carried; // P

  DenseBath(const coupling::Overlap<2> &overlap, const particles::Particles<2> &atoms,
            const std::function<double(double)> &kept_at)
  {
    for (const auto &m : overlap.members)
      if (!m.pad)
        particles.push_back(m.particle);
    const auto n = Eigen::Index(particles.size());
    mass.resize(n);
    kept.resize(n);
    Dense shapes = Dense::Zero(n, overlap.n_nodes());
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto &m = overlap.members[overlap.member_of_particle[particles[i]]];
      mass[i] = atoms.mass[m.particle];
      kept[i] = kept_at(m.position);
      for (int a = 0; a < 4; ++a)
        shapes(i, m.nodes[a]) += m.value[a];
    }
    // The M-orthogonal projection onto the columns, whatever their rank.
    const Eigen::VectorXd root = mass.cwiseSqrt();
    const Dense scaled = root.asDiagonal() * shapes;
    const Eigen::ColPivHouseholderQR<Dense> qr(scaled);
    const Dense basis = Dense(qr.householderQ()).leftCols(qr.rank());
    carried = root.cwiseInverse().asDiagonal() * basis * basis.transpose() * root.asDiagonal();
  }
  Dense fine() const { return Dense::Identity(carried.rows(), carried.rows()) - carried; }
  Eigen::VectorXd noise_share() const { return (1 - kept.array().square()).sqrt().matrix(); }
};

/// By which one step changes the covariance Q M^-1 Q^T, over that of a free atom.
double change_of_covariance(const DenseBath &b, bool with_carried, bool with_noise)
{
  const Dense q = b.fine(), inverse = b.mass.cwiseInverse().asDiagonal(),
              c = q * inverse * q.transpose(), g = b.kept.asDiagonal(),
              s = b.noise_share().asDiagonal();
  Dense next = g * c * g;
  if (with_carried)
    next += g * b.carried * inverse * b.carried.transpose() * g;
  if (with_noise)
    next += s * inverse * s;
  return (q * next * q.transpose() - c).cwiseAbs().maxCoeff() * b.mass.minCoeff();
}

CrystalParameters<2> warm(double fine_damper)
{
  CrystalParameters<2> p;
  p.split.fine_damper = fine_damper;
  p.split.thermal_energy = thermal_energy;
  p.split.seed = 5;
  return p;
}

double kept_by(double strength, double dt, double s)
{
  return std::exp(-strength * dt * std::pow(1 - s, 1.5));
}

TEST(Heat, CovarianceOfTheFineMotionIsStationary)
{
  const CrystalStrip<2> strip(warm(8), 6, 30, 8);
  for (const double strength : {0.01, 0.5, 20.}) {
    const DenseBath bath(*strip.body.split->overlap(), strip.body.zone->state,
                         [&](double s) { return kept_by(strength, 1, s); });
    EXPECT_LT(change_of_covariance(bath, true, true), 1e-10) << strength;
    EXPECT_GT(change_of_covariance(bath, true, false), 1e-2) << strength;
    std::printf("friction %g: covariance changes by %.1e; without the carried noise %.1e, without "
                "noise %.1e\n",
                strength, change_of_covariance(bath, true, true),
                change_of_covariance(bath, false, true), change_of_covariance(bath, true, false));
    if (strength > 0.1) {
      EXPECT_GT(change_of_covariance(bath, false, true), 1e-4) << strength;
    }
  }
}

// The program's step against the matrices, with the numbers of the same streams.
TEST(Heat, TheStepIsThatOfTheFormula)
{
  CrystalStrip<2> strip(warm(8), 6, 30, 8);
  const auto &overlap = *strip.body.split->overlap();
  auto &atoms = strip.body.zone->state;
  const auto kept = [](double s) { return kept_by(0.7, 1, s); };
  const DenseBath bath(overlap, atoms, kept);
  coupling::FineMotion<2> fine(
      {overlap, atoms}, {overlap, atoms}, [](double) { return 0.; }, coupling::Solver::eigen);
  fine.join_bath(overlap, kept);
  const core::ThermalNoise noise(3, 11);
  const coupling::Nodal<2> still = coupling::Nodal<2>::Zero(overlap.n_nodes(), 2);
  constexpr double dt = 0.3;
  for (const double energy : {0., 4.}) {
    for (int i = 0; i < atoms.size(); ++i)
      for (int c = 0; c < 2; ++c) {
        atoms.velocity[c][i] = core::ThermalNoise(1, 1)(i, c, 0);
        atoms.force[c][i] = 5 * core::ThermalNoise(1, 2)(i, c, 0);
      }
    fine.take_velocities(still, atoms);
    const auto n = Eigen::Index(bath.particles.size());
    Dense before(n, 2), half(n, 2), first(n, 2), second(n, 2), after(n, 2);
    for (Eigen::Index i = 0; i < n; ++i)
      for (int c = 0; c < 2; ++c) {
        const int k = bath.particles[i];
        before(i, c) = atoms.velocity[c][k];
        half(i, c) = dt / 2 * atoms.force[c][k] / bath.mass[i];
        first(i, c) = std::sqrt(energy / bath.mass[i]) * noise(atoms.global_id[k], c, 0);
        second(i, c) = std::sqrt(energy / bath.mass[i]) * noise(atoms.global_id[k], c, 1);
      }
    // As it was half-way through the kick.
    half = bath.fine() * half;
    before -= half;
    fine.exchange_heat(energy, noise, dt, still, atoms);
    for (Eigen::Index i = 0; i < n; ++i)
      for (int c = 0; c < 2; ++c)
        after(i, c) = atoms.velocity[c][bath.particles[i]];
    const Dense expected = bath.fine() * (bath.kept.asDiagonal() * (before + bath.carried * first) +
                                          bath.noise_share().asDiagonal() * second) +
                           half;
    EXPECT_LT((after - expected).cwiseAbs().maxCoeff(), 1e-12) << energy;
    EXPECT_LT((bath.carried * after).cwiseAbs().maxCoeff(), 1e-13 * after.cwiseAbs().maxCoeff());
    // What the bath has taken is what the motion has lost.
    const double lost =
        (bath.mass.asDiagonal() * (before.cwiseAbs2() - (after - half).cwiseAbs2())).sum() / 2;
    EXPECT_NEAR(fine.bath_energy(), lost, 1e-12 * before.cwiseAbs2().sum());
    fine.reset_bath_energy();
  }
}

double total(const CoupledBodies<2> &body, const coupling::StepTime &time)
{
  const auto e = body.split->energy(body.bodies(), time);
  return e.kinetic_discrete + e.kinetic_far + e.potential_discrete + e.potential_far + e.blended +
         e.impulses + e.thermostat;
}

/// Mean and its standard error, from the means of 20 blocks.
struct Mean
{
  double value, error;
};
Mean mean_of(const std::vector<double> &values)
{
  constexpr int n_blocks = 20;
  const std::size_t n = values.size() / n_blocks;
  double sum = 0, squares = 0;
  for (int b = 0; b < n_blocks; ++b) {
    double block = 0;
    for (std::size_t k = 0; k < n; ++k)
      block += values[b * n + k] / double(n);
    sum += block / n_blocks;
    squares += block * block / n_blocks;
  }
  return {sum, std::sqrt((squares - sum * sum) / (n_blocks - 1))};
}

/// A body whose particles and nodes start at twice kT, from positions at rest.
CrystalStrip<2> hot_strip(double zone_friction)
{
  auto p = warm(8);
  p.step_fraction = share_of_step;
  p.split.zone_friction = zone_friction;
  CrystalStrip<2> strip(p, 10, 8, 8);
  auto &body = strip.body;
  const core::ThermalNoise noise(2, 0);
  auto &atoms = body.zone->state;
  for (int c = 0; c < 2; ++c) {
    for (int i = 0; i < atoms.size(); ++i)
      atoms.velocity[c][i] = std::sqrt(2 * thermal_energy / atoms.mass[i]) * noise(i, c, 0);
    for (int i = 0; i < body.far->mesh().n_nodes(); ++i)
      body.far->velocity[c][i] = std::sqrt(2 * thermal_energy / 16) * noise(i, c, 1);
  }
  body.far->distribute();
  auto bodies = body.bodies();
  body.split->take_velocities(bodies);
  return strip;
}

TEST(Heat, AHarmonicCrystalHasItsTemperature)
{
  auto strip = hot_strip(0);
  auto &body = strip.body;
  auto bodies = body.bodies();
  coupling::StepTime time;
  time.dt = body.dt;
  body.split->compute_forces(bodies, time);
  const double first = total(body, time);
  double largest = 0;
  std::vector<double> fine, zone;
  const int n_first = 20000, n = 80000;
  for (int k = 0; k < n_first + n; ++k) {
    advance(body, time);
    if (k % 50 == 0) {
      body.split->compute_forces(bodies, time);
      keep_largest(largest, std::abs(total(body, time) - first));
    }
    if (k < n_first)
      continue;
    fine.push_back(body.split->thermal_energy_of_fine(bodies) / thermal_energy);
    zone.push_back(body.split->thermal_energy_of_zone(bodies) / thermal_energy);
  }
  const Mean f = mean_of(fine), z = mean_of(zone);
  std::printf("kinetic energy over kT/2: w %.4f +- %.4f, zone %.4f +- %.4f; ledger %.1e\n", f.value,
              f.error, z.value, z.error, largest / first);
  EXPECT_LT(f.error, 0.01);
  EXPECT_GT(f.value, 1 - 5 * f.error);
  EXPECT_LT(f.value, warmest + 5 * f.error);
  EXPECT_LT(z.error, 0.02);
  EXPECT_GT(z.value, 1 - 5 * z.error);
  EXPECT_LT(z.value, warmest + 5 * z.error);
  EXPECT_LT(largest, 1e-10 * first);
}

// Without forces: after some exchanges nothing is left of how velocities were, and what the bath
// gives is what they have. Squares of near-normal numbers have the variance 1.7, three exchanges
// with half of the velocity kept make new ones.
TEST(Heat, TheZoneBathAloneHasItsTemperature)
{
  const CrystalStrip<2> strip(hot_strip(0.01));
  auto atoms = strip.body.zone->state;
  for (int c = 0; c < 2; ++c) {
    std::fill(atoms.velocity[c].begin(), atoms.velocity[c].end(), 0.);
    std::fill(atoms.force[c].begin(), atoms.force[c].end(), 0.);
  }
  coupling::ZoneBath<2> bath(*strip.body.split->overlap(), atoms.size());
  const int n_first = 20, n = 300;
  double sum = 0;
  for (int k = 0; k < n_first + n; ++k) {
    bath.exchange_heat(0.5, thermal_energy, core::ThermalNoise(3, k), 1, atoms);
    if (k >= n_first)
      sum += 2 * bath.kinetic_energy(atoms) / double(bath.n_free()) / n;
  }
  const double error = std::sqrt(1.7 / (double(bath.n_free()) * n / 3));
  EXPECT_LT(error, 0.01);
  EXPECT_NEAR(sum / thermal_energy, 1, 5 * error);
  EXPECT_NEAR(-bath.taken, bath.kinetic_energy(atoms), 1e-12 * bath.kinetic_energy(atoms));
}

// The harmonic crystal without its mesh: temperature, closed ledger, and the bits of a run that is
// taken up again.
TEST(Heat, AtomsAloneHaveTheirTemperature)
{
  CrystalStrip<2> strip(hot_strip(0.01));
  core::Timers timers;
  coupling::Bodies<2> bodies = {strip.body.zone.get(), nullptr};
  const double dt = strip.body.dt;
  const auto make = [&] {
    return coupling::HeatedParticles<2>(bodies, {thermal_energy, 0.02 / dt, 5}, timers);
  };
  auto alone = make();
  alone.start(bodies);
  coupling::StepTime time{0, 0, dt};
  const auto step = [&] {
    alone.compute_forces(bodies, time);
    alone.kick(bodies, time);
    alone.drift(bodies, time);
    ++time.step;
  };
  const auto sum = [&] {
    alone.compute_forces(bodies, time);
    const auto e = alone.energy(bodies, time);
    return e.kinetic_discrete + e.potential_discrete + e.thermostat;
  };
  const double first = sum();
  std::vector<double> energies;
  const int n_first = 2000, n = 20000;
  for (int k = 0; k < n_first + n; ++k) {
    step();
    if (k >= n_first)
      energies.push_back(alone.thermal_energies(bodies)[0] / thermal_energy);
  }
  const Mean mean = mean_of(energies);
  EXPECT_LT(mean.error, 0.01);
  EXPECT_GT(mean.value, 1 - 5 * mean.error);
  EXPECT_LT(mean.value, warmest + 5 * mean.error);
  EXPECT_NEAR(sum(), first, 1e-10 * first);

  core::State state;
  strip.body.zone->save(state);
  alone.save(state, bodies);
  const auto later = [&] {
    const long at = time.step;
    for (int k = 0; k < 20; ++k)
      step();
    time.step = at;
    return strip.body.zone->state.velocity;
  };
  const auto whole = later();
  const double taken = alone.energy(bodies, time).thermostat;
  strip.body.zone->load(state);
  alone.load(state, bodies);
  EXPECT_EQ(later(), whole);
  EXPECT_EQ(alone.energy(bodies, time).thermostat, taken);
}

TEST(Heat, ARunIsTakenUpAgainToTheBit)
{
  const auto run = [](bool breaks) {
    auto strip = std::make_unique<CrystalStrip<2>>(hot_strip(0.01));
    coupling::StepTime time;
    time.dt = strip->body.dt;
    for (int k = 0; k < 40; ++k) {
      if (k == 20 && breaks) {
        core::State state;
        strip->body.zone->save(state);
        std::vector<std::int64_t> numbers_of(strip->body.far->mesh().n_nodes());
        std::iota(numbers_of.begin(), numbers_of.end(), 0);
        const core::Names numbers(numbers_of);
        strip->body.far->save(state, numbers);
        strip->body.split->save(state, strip->body.bodies());
        strip = std::make_unique<CrystalStrip<2>>(hot_strip(0.01));
        strip->body.zone->load(state);
        strip->body.far->load(state, numbers);
        auto bodies = strip->body.bodies();
        strip->body.split->load(state, bodies);
      }
      advance(strip->body, time);
    }
    auto bodies = strip->body.bodies();
    strip->body.split->compute_forces(bodies, time);
    return std::pair(strip->body.zone->state.velocity,
                     strip->body.split->energy(bodies, time).thermostat);
  };
  const auto whole = run(false), broken = run(true);
  EXPECT_EQ(whole.first, broken.first);
  EXPECT_EQ(whole.second, broken.second);
  EXPECT_NE(whole.second, 0);
}

/// Of a box of crystal held for so many steps; it takes the load.
coupling::ThermalLoad<2> hold(CoupledBodies<2> &body)
{
  coupling::HeldRun run;
  run.equilibration = 1000 * body.dt;
  run.averaging = 8000 * body.dt;
  run.friction = 0.1 / body.dt_zone;
  auto bodies = body.bodies();
  const auto load = body.split->held_thermal_load(bodies, run, body.dt);
  body.split->set_dead_load(load.force, bodies);
  return load;
}

double largest(const coupling::Nodal<2> &force)
{
  return force.rowwise().norm().maxCoeff();
}

CrystalParameters<2> warm_box(double energy, bool is_harmonic)
{
  auto p = warm(8);
  p.turn = 0.4;
  p.cell_size = 3.1;
  p.size = {56, 55};
  p.zone_size = {29.2, 28.7};
  p.is_harmonic = is_harmonic;
  p.step_fraction = 0.2;
  p.split.thermal_energy = energy;
  return p;
}

// Linear forces have the mean of their places: the load is the one at rest. Others push.
TEST(Heat, TheLoadOfAHeldMeshIsTheMeanForce)
{
  for (const bool is_harmonic : {true, false}) {
    auto body = make_crystal(warm_box(4e-3, is_harmonic));
    const auto still = body.split->dead_load();
    const auto load = hold(body);
    const double change = largest(load.force - still);
    std::printf("%s: largest change %.1e, error %.1e, over C11 h\n",
                is_harmonic ? "harmonic" : "anharmonic", change / force_scale(body),
                load.error / force_scale(body));
    EXPECT_LT(body.split->dead_load().colwise().sum().cwiseAbs().maxCoeff(),
              1e-12 * largest(load.force));
    // Of some hundred nodes the largest is within 4 of its own errors, which differ by a factor.
    if (is_harmonic)
      EXPECT_LT(change, 10 * load.error);
    else
      EXPECT_GT(change, 10 * load.error);
    auto bodies = body.bodies();
    EXPECT_EQ(body.split->energy(bodies, {0, 0, body.dt}).thermostat, 0);
    // Another body takes it from the state.
    core::State state;
    body.split->save(state, bodies);
    auto other = make_crystal(warm_box(4e-3, is_harmonic));
    auto others = other.bodies();
    other.split->load(state, others);
    EXPECT_EQ(other.split->dead_load(), body.split->dead_load());
  }
}

// Nodes have no bath of their own: they become as warm as the places of the atoms that have one.
// With friction after the whole kick these are hotter than motions by half of what it takes in a
// step, here by up to 10 %.
TEST(Heat, NodesAreNoWarmerThanTheBath)
{
  auto body = make_crystal(warm_box(thermal_energy, true));
  hold(body);
  auto bodies = body.bodies();
  coupling::StepTime time;
  time.dt = body.dt;
  std::vector<double> nodes;
  for (int k = 0; k < 40000; ++k) {
    advance(body, time);
    if (k >= 10000 && k % 10 == 0)
      nodes.push_back(body.split->thermal_energies(bodies)[2] / thermal_energy);
  }
  const Mean v = mean_of(nodes);
  std::printf("kinetic energy of the nodes over kT/2: %.4f +- %.4f\n", v.value, v.error);
  EXPECT_LT(v.error, 0.01);
  EXPECT_NEAR(v.value, 1, 5 * v.error);
}

// A wrong load strains the body until the overlap bears it: how far atoms have gone by then tells
// what it should have been. Almost without heat that is the load at rest.
TEST(Heat, TheLoadOfAFreeMeshForgetsAWrongOne)
{
  auto body = make_crystal(warm_box(1e-9, false));
  const auto right = body.split->dead_load();
  // A pull of strain 1e-4 at the near nodes.
  const auto &overlap = *body.split->overlap();
  const int n = overlap.n_nodes();
  Eigen::VectorXd u(2 * n); // all of one component after another
  for (int i = 0; i < n; ++i)
    for (int c = 0; c < 2; ++c)
      u[c * n + i] = 1e-4 * body.far->mesh().nodes[overlap.near_nodes[i]][c];
  const Eigen::VectorXd force = body.split->near_stiffness() * u;
  const coupling::Nodal<2> wrong = force.reshaped(n, 2);
  auto bodies = body.bodies();
  body.split->set_dead_load(right + wrong, bodies);
  const auto load = body.split->free_thermal_load(bodies, 8000 * body.dt, body.dt);
  const coupling::Nodal<2> rest = load.force - right;
  EXPECT_GT(largest(wrong), 1e-5 * force_scale(body));
  // Anharmonic in the strain: about ten times 1e-4 of it.
  EXPECT_LT(largest(rest), 3e-3 * largest(wrong));
}
} // namespace
} // namespace ligament
