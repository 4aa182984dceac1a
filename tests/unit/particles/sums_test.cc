// Sums over particles have no order: its blocks numbered anew or cut into parts, a body has the
// same energies to the last bit.
#include "core/dashpots.h"
#include "particles/block_sum.h"
#include "particles/particle_solver.h"
#include "tests/unit/particles/given_force.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>

namespace ligament::particles
{
namespace
{
template <int dim>
using Solver = ParticleSolver<dim>;

constexpr int block = sum_block, n_blocks = 50, n_particles = block * n_blocks;

/// As behind a wave front: motions of all sizes, some particles held.
template <int dim>
Particles<dim> noise()
{
  Particles<dim> p;
  p.resize(n_particles);
  p.gyration = 0.1;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> mantissa(-1, 1);
  std::uniform_int_distribution<int> power(-30, 0);
  const auto draw = [&](std::vector<double> &values) {
    for (double &v : values)
      v = std::ldexp(mantissa(random), power(random));
  };
  for (int c = 0; c < dim; ++c) {
    draw(p.velocity[c]);
    draw(p.force[c]);
  }
  for (int c = 0; c < n_spins<dim>; ++c) {
    draw(p.spin[c]);
    draw(p.torque[c]);
  }
  for (int i = 0; i < n_particles; ++i)
    p.mass[i] = i % 97 == 0 ? std::numeric_limits<double>::infinity() : 1 + mantissa(random) / 2;
  return p;
}

/// Of these particles of a body, in this order.
template <int dim>
Solver<dim> part_of(const Particles<dim> &body, const std::vector<int> &chosen)
{
  Particles<dim> p;
  p.resize(int(chosen.size()));
  p.gyration = body.gyration;
  const auto copy = [&](const auto &from, auto &to) {
    for (std::size_t c = 0; c < from.size(); ++c)
      for (std::size_t k = 0; k < chosen.size(); ++k)
        to[c][k] = from[c][chosen[k]];
  };
  copy(body.velocity, p.velocity);
  copy(body.force, p.force);
  copy(body.spin, p.spin);
  copy(body.torque, p.torque);
  for (std::size_t k = 0; k < chosen.size(); ++k)
    p.mass[k] = body.mass[chosen[k]];
  return Solver<dim>(std::move(p), std::make_unique<GivenForce<dim>>());
}

/// What a sum in this order gives, for the test that the order matters to it.
template <int dim>
double plain_kinetic_energy(const Particles<dim> &p, double dt)
{
  double sum = 0;
  for (int i = 0; i < p.size(); ++i)
    for (int c = 0; c < dim && !std::isinf(p.mass[i]); ++c)
      sum += p.velocity[c][i] * (p.mass[i] * p.velocity[c][i] + dt * p.force[c][i]) / 2;
  return sum;
}

template <int dim>
void check_orders_and_parts()
{
  const double dt = 0.25, factor = 0.75;
  const auto body = noise<dim>();
  // Particles of the blocks begin to end of this order.
  std::vector<int> order(n_blocks);
  const auto particles = [&](int begin, int end) {
    std::vector<int> chosen;
    for (int b = begin; b < end; ++b)
      for (int k = 0; k < block; ++k)
        chosen.push_back(order[b] * block + k);
    return chosen;
  };
  std::iota(order.begin(), order.end(), 0);
  auto whole = part_of(body, particles(0, n_blocks));
  const double kinetic = whole.kinetic_energy(dt);
  const auto before = whole.damp_velocities(factor, dt), after = whole.damp_velocities(factor, -dt);
  EXPECT_GT(kinetic, 0);
  EXPECT_GT(before.value(), 0);

  std::mt19937_64 random(8);
  std::shuffle(order.begin(), order.end(), random);
  auto shuffled = part_of(body, particles(0, n_blocks));
  EXPECT_NE(plain_kinetic_energy(shuffled.state, dt), plain_kinetic_energy(body, dt));
  EXPECT_EQ(shuffled.kinetic_energy(dt), kinetic);
  EXPECT_EQ(shuffled.damp_velocities(factor, dt).words(), before.words());
  EXPECT_EQ(shuffled.damp_velocities(factor, -dt).words(), after.words());

  core::ExactSum kinetic_of_parts, damped_of_parts;
  for (const auto &[begin, end] : {std::pair(0, 13), std::pair(13, 14), std::pair(14, n_blocks)}) {
    auto part = part_of(body, particles(begin, end));
    kinetic_of_parts.merge(part.kinetic_sum(dt));
    damped_of_parts.merge(part.damp_velocities(factor, dt));
  }
  EXPECT_EQ(kinetic_of_parts.value(), kinetic);
  EXPECT_EQ(damped_of_parts.words(), before.words());
}

TEST(Sums, OfBlocksHaveNoOrder)
{
  check_orders_and_parts<2>();
  check_orders_and_parts<3>();
}

// The loss of the velocities is what it takes from the energy.
TEST(Sums, DampingTakesWhatTheKineticEnergyLoses)
{
  auto p = noise<3>();
  std::fill(p.mass.begin(), p.mass.end(), 2.);
  Solver<3> solver(std::move(p), std::make_unique<GivenForce<3>>());
  const double dt = 0.25, before = solver.kinetic_energy(dt);
  const double taken = solver.damp_velocities(0.75, dt).value();
  // Each term rounds some ten times, the exact sums once.
  EXPECT_NEAR(taken, before - solver.kinetic_energy(dt), 20 * 2e-16 * before);
}

TEST(Sums, OfDashpotsHaveNoOrder)
{
  const auto p = noise<2>();
  // The same dashpots under the particles' own numbers and numbered backwards, 50 steps each.
  const auto energy = [&](bool backwards) {
    const auto place = [&](int i) { return backwards ? n_particles - 1 - i : i; };
    core::Dashpots<2>::Places places;
    Components<2> velocity = p.velocity, force = p.force;
    std::vector<double> mass(n_particles);
    for (int i = 0; i < n_particles; ++i) {
      places[{place(i), i % 2}] = {{core::Dashpot::Kind::face, 1e-3, 0.5}};
      mass[place(i)] = p.mass[i];
      for (int c = 0; c < 2; ++c) {
        velocity[c][place(i)] = p.velocity[c][i];
        force[c][place(i)] = p.force[c][i];
      }
    }
    core::Dashpots<2> dashpots(places);
    for (int step = 0; step < 50; ++step)
      dashpots.act(
          0.25, [&](int i) { return 1 / mass[i]; }, force, velocity);
    return dashpots.energy();
  };
  EXPECT_NE(energy(false), 0);
  EXPECT_EQ(energy(false), energy(true));
}
} // namespace
} // namespace ligament::particles
