// The state of particles: names, masses, and what a kick makes of them.
#include "particles/particle_solver.h"
#include "tests/unit/particles/given_force.h"

#include <gtest/gtest.h>

#include <limits>

namespace ligament::particles
{
namespace
{
TEST(GlobalIds, ReadLikeTheArrayTheyWereMadeOf)
{
  const std::vector<std::int64_t> ids = {7, 8, 9, 3, 5, 6, 4, std::int64_t(1) << 60};
  const GlobalIds names(ids);
  EXPECT_EQ(names.list(), ids);
  for (int i = 0; i < names.size(); ++i)
    EXPECT_EQ(names[i], ids[i]);
  EXPECT_EQ(GlobalIds(3).list(), (std::vector<std::int64_t>{0, 1, 2}));
  EXPECT_EQ(GlobalIds(std::vector<std::int64_t>()).size(), 0);
}

template <int dim>
void check_kick()
{
  Particles<dim> p;
  p.resize(2);
  p.gyration = 0.1;
  p.mass = {4, std::numeric_limits<double>::infinity()}; // the second one is held
  for (int i = 0; i < 2; ++i) {
    p.force[1][i] = 3;
    p.torque[0][i] = 2;
  }
  p.velocity[1][0] = 0.5;
  ParticleSolver<dim> solver(std::move(p), std::make_unique<GivenForce<dim>>());
  const auto &s = solver.state;
  const double dt = 0.25;
  EXPECT_DOUBLE_EQ(solver.kinetic_energy(dt), (4 * 0.5 * (0.5 + dt * 3 / 4)) / 2);
  solver.kick(dt);
  EXPECT_DOUBLE_EQ(s.velocity[1][0], 0.5 + dt * 3 / 4);
  EXPECT_DOUBLE_EQ(s.spin[0][0], dt * 2 / (0.1 * 4));
  EXPECT_EQ(s.velocity[0][0], 0);
  EXPECT_EQ(s.velocity[1][1], 0);
  EXPECT_EQ(s.spin[0][1], 0);
  EXPECT_EQ(s.inverse_inertia(1), 0);
}

TEST(ParticleSolver, KicksByForceOverMassAndLeavesHeldParticles)
{
  check_kick<2>();
  check_kick<3>();
}

template <int dim>
struct CentralForce : GivenForce<dim>
{
  bool has_rotations() const override { return false; }
};

// All verbs of the step, at rest and awake.
template <int dim>
void check_without_orientations()
{
  Particles<dim> p;
  p.resize(3);
  p.mass = {1, 2, 4};
  p.reference[0] = {0, 1, 2};
  p.velocity[1] = {0, 0, 0.5};
  p.force[1] = {0, 0, 8};
  ParticleSolver<dim> solver(std::move(p), std::make_unique<CentralForce<dim>>());
  auto &s = solver.state;
  int n_arrays = 0;
  s.for_each_array([&](const char *name, const std::vector<double> &array) {
    EXPECT_EQ(array.size(), 3u) << name;
    ++n_arrays;
  });
  EXPECT_EQ(n_arrays, 4 * dim + 2); // reference, displacement, velocity, force; volume, mass
  EXPECT_TRUE(s.rotation[0].empty() && s.spin[0].empty() && s.torque[0].empty());
  solver.let_rest();
  EXPECT_TRUE(solver.rest()->is_awake(2));
  const double dt = 0.25, v = 0.5 + dt * 8 / 4;
  EXPECT_DOUBLE_EQ(solver.kinetic_energy(dt), 4 * 0.5 * v / 2);
  solver.kick(dt);
  solver.drift(dt);
  EXPECT_DOUBLE_EQ(s.displacement[1][2], dt * v);
  EXPECT_DOUBLE_EQ(solver.damp_velocities(0.5, 0).value(), (1 - 0.25) * 4 * v * v / 2);
  solver.scale_velocities(2);
  EXPECT_DOUBLE_EQ(s.velocity[1][2], v);
}

TEST(ParticleSolver, CarriesNoOrientationsWhereTheForceKnowsNone)
{
  check_without_orientations<2>();
  check_without_orientations<3>();
}
} // namespace
} // namespace ligament::particles
