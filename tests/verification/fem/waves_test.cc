// Waves on the mesh against the dispersion of lumped linear cells and against the continuum.
#include "fem/fem_solver.h"
#include "tests/unit/fem/meshes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ligament::fem
{
namespace
{
constexpr double lambda = 3, shear = 2, density = 0.5;
const double c_p = std::sqrt((lambda + 2 * shear) / density);

/// Sides on which the normal displacement is zero and the shear traction is.
template <int dim>
std::vector<core::BoundaryLoad<dim>> rollers(int first_side = 0, int end_side = 2 * dim)
{
  std::vector<core::BoundaryLoad<dim>> loads;
  for (int side = first_side; side < end_side; ++side) {
    core::BoundaryLoad<dim> load;
    load.boundary = side;
    load.kind = core::BoundaryLoad<dim>::Kind::displacement;
    load.value[side / 2] = 0;
    loads.push_back(load);
  }
  return loads;
}

template <int dim, typename Field>
void set_displacement(FemSolver<dim> &solver, Field field)
{
  for (int i = 0; i < solver.mesh().n_nodes(); ++i)
    set<dim>(solver.displacement, i, field(solver.mesh().nodes[i]));
}

/// Square of the frequency that the mesh gives to a mode: U.K U / U.M U.
template <int dim, typename Field>
double rayleigh_quotient(FemSolver<dim> &solver, Field mode)
{
  set_displacement(solver, mode);
  solver.distribute();
  double mass = 0;
  for (int i = 0; i < solver.mesh().n_nodes(); ++i)
    mass += solver.lumped_mass()[i] * get(solver.displacement, i).squaredNorm();
  return 2 * solver.potential_energy() / mass;
}

/// A longitudinal wave along x that stands between rollers follows, on the mesh and in steps of
/// leap-frog, exactly sin(omega dt/2) = (c_p dt/h) sin(k h/2).
template <int dim>
void check_standing_wave(const Vector<dim> &size)
{
  const double h = 0.125, k = 3 * M_PI / size[0];
  FemSolver<dim> solver(make_mesh(box<dim>(size, h)), {isotropic<dim>(lambda, shear), density, 1},
                        rollers<dim>());
  const double dt = 0.9 * solver.stable_step();
  const double omega = 2 / dt * std::asin(c_p * dt / h * std::sin(k * h / 2));
  const auto wave = [&](double amplitude) {
    return [&, amplitude](const Vector<dim> &x) {
      return Vector<dim>(amplitude * std::sin(k * x[0]) * Vector<dim>::Unit(0));
    };
  };
  set_displacement(solver, wave(1));
  for (int i = 0; i < solver.mesh().n_nodes(); ++i)
    set<dim>(solver.velocity, i,
             Vector<dim>(get(solver.displacement, i) * (1 - std::cos(omega * dt)) / dt));
  double time = 0;
  const int n_steps = 500;
  for (int step = 0; step < n_steps; ++step, time += dt) {
    solver.compute_forces(time);
    solver.kick(dt, time);
    solver.drift(dt);
  }
  double error = 0;
  for (int i = 0; i < solver.mesh().n_nodes(); ++i)
    error = std::max(
        error, (get(solver.displacement, i) - wave(std::cos(omega * time))(solver.mesh().nodes[i]))
                   .norm());
  EXPECT_LT(error, n_steps * 1e-14); // round-off of each step
}

/// Observed order of the frequency error over two halvings.
template <typename Error>
void check_second_order(Error error)
{
  const double e[3] = {error(1), error(2), error(4)};
  EXPECT_GT(std::abs(e[2]), 1e-6); // not lost in round-off
  EXPECT_NEAR(std::log2(e[0] / e[1]), 2, 0.1);
  EXPECT_NEAR(std::log2(e[1] / e[2]), 2, 0.03);
}

/// u = grad prod cos(k_i x_i) between rollers: a dilatational mode of frequency c_p |k|.
template <int dim>
void check_mode_of_a_box()
{
  Vector<dim> size, k;
  for (int i = 0; i < dim; ++i) {
    size[i] = 1 + 0.5 * i;
    k[i] = (i == 0 ? 2 : 1) * M_PI / size[i];
  }
  check_second_order([&](int refinement) {
    FemSolver<dim> solver(make_mesh(box<dim>(size, 0.125 / refinement)),
                          {isotropic<dim>(lambda, shear), density, 1}, rollers<dim>());
    const double quotient = rayleigh_quotient<dim>(solver, [&](const Vector<dim> &x) {
      Vector<dim> u;
      for (int i = 0; i < dim; ++i) {
        u[i] = -k[i] * std::sin(k[i] * x[i]);
        for (int j = 0; j < dim; ++j)
          if (j != i)
            u[i] *= std::cos(k[j] * x[j]);
      }
      return u;
    });
    return std::sqrt(quotient) / (c_p * k.norm()) - 1;
  });
}

/// Above a band the mesh coarsens through two levels of hanging nodes; the mode
/// u_y = cos(k (y - y_inner)) is free at the band and zero at the top, with one wave length and a
/// quarter in between.
template <int dim>
void check_mode_of_a_graded_strip()
{
  check_second_order([&](int refinement) {
    MeshParameters<dim> p = band<dim>();
    p.lower[dim - 1] = p.inner[0].lower[dim - 1] - 1; // nothing below: only the upper strip counts
    p.inner[0].lower[dim - 1] = p.lower[dim - 1] - 1;
    for (int k = 0; k + 1 < dim; ++k)
      p.upper[k] = p.lower[k] + 0.8;
    p.cell_size = 0.1 / refinement;
    p.fine_cells = 6 * refinement - 1;
    p.cells_per_level = refinement;
    FemSolver<dim> solver(make_mesh(p), {isotropic<dim>(lambda, shear), density, 1},
                          rollers<dim>(0, 2 * dim - 2));
    EXPECT_FALSE(solver.mesh().hanging.empty());
    const double y = p.inner[0].upper[dim - 1];
    const double k = 2.5 * M_PI / (p.upper[dim - 1] - y);
    const double quotient = rayleigh_quotient<dim>(solver, [&](const Vector<dim> &x) {
      return Vector<dim>(std::cos(k * (x[dim - 1] - y)) * Vector<dim>::Unit(dim - 1));
    });
    return std::sqrt(quotient) / (c_p * k) - 1;
  });
}
} // namespace

TEST(Waves, standing_wave_in_2d)
{
  check_standing_wave<2>({3, 0.5});
}
TEST(Waves, standing_wave_in_3d)
{
  check_standing_wave<3>({3, 0.5, 0.25});
}
TEST(Waves, order_in_a_box_2d)
{
  check_mode_of_a_box<2>();
}
TEST(Waves, order_in_a_box_3d)
{
  check_mode_of_a_box<3>();
}
TEST(Waves, order_in_a_graded_strip_2d)
{
  check_mode_of_a_graded_strip<2>();
}
TEST(Waves, order_in_a_graded_strip_3d)
{
  check_mode_of_a_graded_strip<3>();
}
} // namespace ligament::fem
