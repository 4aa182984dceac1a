// Meshes whose sides are joined: no side is left, jumps act as homogeneous strains, their work is
// the energy.
#include "core/check.h"
#include "core/extremes.h"
#include "fem/fem_solver.h"
#include "fem/join_sides.h"
#include "tests/unit/fem/meshes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ligament::fem
{
namespace
{
constexpr double lambda = 3e9, shear = 2e9; // Pa
constexpr double thickness = 0.5, density = 2000;

template <int dim>
Body<dim> body()
{
  return {isotropic<dim>(lambda, shear), density, dim == 2 ? thickness : 1};
}

/// A box whose cells are doubled away from its middle, with a hole there or without.
template <int dim>
MeshParameters<dim> box_of(bool has_hole)
{
  MeshParameters<dim> p;
  p.lower = Vector<dim>::Constant(-1);
  p.upper = Vector<dim>::Constant(1);
  p.lower[1] *= dim == 2 ? 1.4 : 1;
  p.upper[1] *= dim == 2 ? 1.4 : 1;
  p.cell_size = dim == 2 ? 0.05 : 0.125;
  if (!has_hole)
    return p;
  p.levels = 1;
  p.fine_cells = 2;
  p.cells_per_level = 2;
  p.inner.push_back({Vector<dim>::Constant(-0.25), Vector<dim>::Constant(0.25)});
  return p;
}

template <int dim>
Mesh<dim> joined_mesh(const MeshParameters<dim> &p, const std::vector<int> &axes)
{
  Mesh<dim> mesh = make_mesh(p);
  for (const int axis : axes)
    join_sides(mesh, axis, p.lower, p.upper);
  return mesh;
}

template <int dim>
std::vector<core::BoundaryLoad<dim>> jumps_of(const Eigen::Matrix<double, dim, dim> &gradient,
                                              const MeshParameters<dim> &p,
                                              const std::vector<int> &axes)
{
  std::vector<core::BoundaryLoad<dim>> loads;
  for (const int a : axes) {
    auto &load = loads.emplace_back();
    load.boundary = core::BoundaryLoad<dim>::jump_across(a);
    load.kind = core::BoundaryLoad<dim>::Kind::displacement;
    for (int c = 0; c < dim; ++c)
      load.value[c] = gradient(c, a) * (p.upper - p.lower)[a];
  }
  return loads;
}

template <int dim>
std::vector<int> all_axes()
{
  std::vector<int> axes;
  for (int a = 0; a < dim; ++a)
    axes.push_back(a);
  return axes;
}

template <int dim>
void check_homogeneous()
{
  const auto p = box_of<dim>(false);
  Eigen::Matrix<double, dim, dim> gradient;
  for (int a = 0; a < dim; ++a)
    for (int b = 0; b < dim; ++b)
      gradient(a, b) = 1e-3 * (1 + a - 2 * b + 3 * a * b);
  FemSolver<dim> solver(joined_mesh(p, all_axes<dim>()), body<dim>(),
                        jumps_of<dim>(gradient, p, all_axes<dim>()));
  EXPECT_TRUE(solver.mesh().boundary_faces.empty());
  for (int i = 0; i < solver.mesh().n_nodes(); ++i)
    set<dim>(solver.displacement, i, Vector<dim>(gradient * solver.mesh().nodes[i]));
  solver.compute_forces(0);
  Eigen::Matrix<double, dim, dim> stress = shear * (gradient + gradient.transpose());
  stress += lambda * gradient.trace() * stress.Identity();
  const double volume = (p.upper - p.lower).prod() * body<dim>().thickness;
  for (int i = 0; i < solver.mesh().n_nodes(); ++i)
    EXPECT_LT(get(solver.force, i).norm(), 1e-12 * stress.norm());
  for (int a = 0; a < dim; ++a) {
    const Vector<dim> pull = stress.col(a) * volume / (p.upper - p.lower)[a];
    EXPECT_LT((solver.reaction(a) - pull).norm(), 1e-12 * pull.norm());
  }
  double mass = 0;
  for (const double m : solver.lumped_mass())
    mass += m;
  EXPECT_NEAR(mass, density * volume, 1e-12 * mass);
}
} // namespace

TEST(JoinedSides, HomogeneousStrainIsExact)
{
  check_homogeneous<2>();
  check_homogeneous<3>();
}

TEST(JoinedSides, ReactionsAreTheSlopesOfTheEnergy)
{
  const auto p = box_of<2>(true);
  const std::vector<int> axes = {0, 1};
  Eigen::Matrix2d gradient;
  gradient << 1, 2, -1, 3;
  const auto loads = jumps_of<2>(gradient, p, axes);
  const auto make = [&](const std::vector<core::BoundaryLoad<2>> &of) {
    FemSolver<2> solver(joined_mesh(p, axes), body<2>(), of);
    for (int i = 0; i < solver.mesh().n_nodes(); ++i)
      set<2>(solver.displacement, i, Vector<2>(std::sin(7. * i), std::cos(3. * i)));
    solver.compute_forces(0);
    return solver;
  };
  const auto solver = make(loads);
  for (const auto &h : solver.mesh().hanging)
    for (const auto &master : h.masters)
      for (const auto &other : solver.mesh().hanging)
        EXPECT_NE(master.first, other.node);
  for (int a = 0; a < 2; ++a)
    for (int c = 0; c < 2; ++c) {
      double energy[2];
      for (const int end : {0, 1}) {
        auto moved = loads;
        *moved[a].value[c] += end ? 0.5 : -0.5; // quadratic: exact for any step
        energy[end] = make(moved).potential_energy();
      }
      EXPECT_NEAR(solver.reaction(a)[c], energy[1] - energy[0], 1e-9 * energy[1]);
    }
}

namespace
{
/// A jump that takes so many seconds to come.
FemSolver<2> sheared(double ramp = 2e-3)
{
  const auto p = box_of<2>(true);
  auto loads = jumps_of<2>(Eigen::Matrix2d::Constant(1e-3), p, {0});
  loads[0].history = core::Ramp{ramp};
  return FemSolver<2>(joined_mesh(p, {0}), body<2>(), loads);
}

void expect_work_is_energy(double ramp)
{
  auto solver = sheared(ramp);
  const double dt = 0.8 * solver.stable_step();
  solver.compute_forces(0);
  // Half a kick of a body at rest: -1/2 and 1/2 of a step differ in sign.
  const double start = -dt * dt / 8 * solver.squared_force();
  solver.kick(dt / 2, 0);
  double worst = 0, largest = 0;
  for (int step = 1; step <= 10000; ++step) {
    solver.drift(dt);
    solver.compute_forces(step * dt);
    const double energy = solver.kinetic_energy(dt) + solver.potential_energy();
    keep_largest(largest, energy);
    keep_largest(worst, std::abs(energy - start - solver.external_work()));
    solver.kick(dt, step * dt);
  }
  EXPECT_GT(largest, 0);
  EXPECT_LT(worst, 1e-11 * largest);
}
} // namespace

TEST(JoinedSides, TheWorkOfTheJumpIsTheEnergy)
{
  for (const double ramp : {2e-3, 0.})
    expect_work_is_energy(ramp);
}

TEST(JoinedSides, ResumeToTheBit)
{
  auto whole = sheared(), first = sheared(), second = sheared();
  const auto p = box_of<2>(true);
  const double dt = 0.8 * whole.stable_step();
  const auto go = [&](FemSolver<2> &solver, int from, int to) {
    for (int step = from; step < to; ++step) {
      if (step == 0) {
        solver.compute_forces(0);
        solver.kick(dt / 2, 0);
      } else {
        solver.compute_forces(step * dt);
        solver.kick(dt, step * dt);
      }
      solver.drift(dt);
    }
  };
  go(whole, 0, 300);
  go(first, 0, 200);
  core::State state;
  const auto names = node_names<2>(first.mesh(), p.lower, p.upper);
  first.save(state, names);
  second.load(state, names);
  go(second, 200, 300);
  EXPECT_EQ(whole.displacement, second.displacement);
  EXPECT_EQ(whole.velocity, second.velocity);
  EXPECT_EQ(whole.external_work(), second.external_work());
}

TEST(JoinedSides, SidesThatDifferAreRefusedWithTheirPlace)
{
  auto p = box_of<2>(true);
  p.inner[0].lower[0] += 0.55; // four fine cells are left on the right, and all others on the left
  p.inner[0].upper[0] += 0.55;
  try {
    joined_mesh<2>(p, {0});
    FAIL() << "no error";
  } catch (const core::InputError &error) {
    EXPECT_NE(std::string(error.what()).find("has no twin on the other side"), std::string::npos);
  }
}
} // namespace ligament::fem
