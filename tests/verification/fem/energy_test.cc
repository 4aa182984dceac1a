// The exact invariant of leap-frog on graded meshes with hanging nodes, free and under loads.
#include "core/extremes.h"
#include "fem/fem_solver.h"
#include "tests/unit/fem/meshes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ligament::fem
{
namespace
{
template <int dim>
void set_noise(FemSolver<dim> &solver)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (auto &v : solver.velocity)
    for (double &x : v)
      x = uniform(random);
}

/// Largest change of kinetic + potential + damped - work, over the largest energy on the way.
template <int dim>
double drift_of_the_invariant(FemSolver<dim> &solver, int n_steps, bool is_damped = false)
{
  const double dt = 0.95 * solver.stable_step();
  double time = 0, first = 0, error = 0, largest = 0, damped = 0;
  solver.set_mass_damping(is_damped ? 0.02 / dt : 0);
  for (int step = 0; step <= n_steps; ++step, time += dt) {
    solver.compute_forces(time);
    if (step % 50 == 0) {
      const double kinetic = solver.kinetic_energy(dt), potential = solver.potential_energy();
      const double energy = kinetic + potential + damped - solver.external_work();
      if (step == 0)
        first = energy;
      keep_largest(error, std::abs(energy - first));
      largest = std::max({largest, std::abs(kinetic), std::abs(potential)});
    }
    if (is_damped)
      damped += solver.damp_velocities(dt);
    solver.kick(dt, time);
    if (is_damped)
      damped += solver.damp_velocities(-dt);
    solver.drift(dt);
  }
  return error / largest;
}

template <int dim>
void check_noise()
{
  // At 0.95 of the element bound: that the run stays finite tests the bound, too.
  MeshParameters<dim> p = incommensurate(ring<dim>());
  if (dim == 3) {
    p.levels = 1;
    p.fine_cells = 1;
    p.cell_size = 0.2;
  }
  FemSolver<dim> solver(make_mesh(p), {isotropic<dim>(3, 2), 0.5, 1}, {});
  ASSERT_FALSE(solver.mesh().hanging.empty());
  set_noise(solver);
  EXPECT_LT(drift_of_the_invariant(solver, 10000), 1e-10);
}

template <int dim>
void check_work(bool is_damped)
{
  using Load = core::BoundaryLoad<dim>;
  Load pull, push, side;
  pull.boundary = 2 * dim - 1;
  pull.kind = Load::Kind::velocity;
  pull.value[dim - 1] = 0.1;
  pull.value[0] = 0.02;
  pull.history = core::Ramp{3};
  push.boundary = 1;
  push.kind = Load::Kind::traction;
  push.value[0] = -0.3;
  push.value[1] = 0.2;
  push.history = core::Ramp{1};
  side.boundary = 2 * dim - 2;
  side.kind = Load::Kind::displacement;
  side.value[dim - 1] = -0.05;
  side.history = core::Ramp{2};
  FemSolver<dim> solver(make_mesh(ring<dim>()), {isotropic<dim>(3, 2), 0.5, 1}, {pull, push, side});
  EXPECT_LT(drift_of_the_invariant(solver, 1000, is_damped), 1e-12);
  EXPECT_GT(solver.external_work(), 1e-3);
}
} // namespace

TEST(Energy, of_noise_is_kept_in_2d)
{
  check_noise<2>();
}
TEST(Energy, of_noise_is_kept_in_3d)
{
  check_noise<3>();
}
TEST(Energy, grows_by_the_work_of_loads)
{
  check_work<2>(false);
  check_work<3>(false);
}
TEST(Energy, that_damping_takes_is_booked_at_held_nodes_too)
{
  check_work<2>(true);
  check_work<3>(true);
}
} // namespace ligament::fem
