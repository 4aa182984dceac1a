// The finite solver on meshes of general cells beside boxes, hanging nodes included: the patch
// test, the kernel against a naive sum, loads on inclined sides, energy and the stable step.
#include "core/check.h"
#include "core/extremes.h"
#include "fem/cell_kernel.h"
#include "fem/fem_solver.h"
#include "tests/support/distorted_meshes.h"
#include "tests/unit/fem/meshes.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>

namespace ligament::fem
{
namespace
{
constexpr double lambda = 3, shear = 2, density = 0.5, thickness = 0.5;

template <int dim>
using Matrix = Eigen::Matrix<double, dim, dim>;

template <int dim>
Body<dim> body()
{
  return {isotropic<dim>(lambda, shear), density, dim == 2 ? thickness : 1};
}

/// Coarser in 3D, where cells are many.
template <int dim>
MeshParameters<dim> graded()
{
  auto p = incommensurate(ring<dim>());
  if (dim == 3) {
    p.levels = 1;
    p.fine_cells = 1;
    p.cell_size = 0.2;
  }
  return p;
}

/// Hanging nodes, boxes, equal cells and cells of no other's shape.
template <int dim>
std::vector<Mesh<dim>> meshes()
{
  const Mesh<dim> boxes = make_mesh(graded<dim>());
  const auto slanted = [](const Vector<dim> &x) -> Vector<dim> { return slant<dim>() * x; };
  const auto beyond = [](const Vector<dim> &x) { return x[0] > 0.5; };
  std::vector<Mesh<dim>> list = {mapped(boxes, slanted), distorted(boxes, 0.2),
                                 distorted(boxes, 0.2, 3, beyond),
                                 mapped(distorted(boxes, 0.2, 5, beyond), slanted)};
  if constexpr (dim == 2) // sides are curved, too
    list.push_back(mapped(boxes, [](const Vector<2> &x) {
      return Vector<2>(x[0] + 0.05 * x[1] * x[1], x[1] - 0.03 * x[0] * x[0]);
    }));
  return list;
}

template <int dim>
Components<dim> zeros(const Mesh<dim> &mesh)
{
  Components<dim> f;
  for (auto &x : f)
    x.assign(mesh.n_nodes(), 0.);
  return f;
}

template <int dim>
double largest(const Components<dim> &a)
{
  double x = 0;
  for (const auto &values : a)
    for (const double value : values)
      keep_largest(x, std::abs(value));
  return x;
}

template <int dim>
void hand_to_masters(const Mesh<dim> &mesh, Components<dim> &f)
{
  for (auto &x : f)
    for (const auto &h : mesh.hanging) {
      for (const auto &[master, weight] : h.masters)
        x[master] += weight * x[h.node];
      x[h.node] = 0;
    }
}

/// sigma n over all faces of the boundary, stress as a tensor; sides are plane.
template <int dim>
Components<dim> boundary_forces(const Mesh<dim> &mesh, const Matrix<dim> &stress)
{
  Components<dim> f = zeros(mesh);
  for (const auto &face : mesh.boundary_faces) {
    const auto corners = cell_corners(mesh, face.cell);
    const auto shares = face_shares<dim>(corners, face.face);
    const Vector<dim> pull = body<dim>().thickness * stress * face_normal<dim>(corners, face.face);
    for (int a = 0; a < n_cell_nodes<dim>; ++a)
      add<dim>(f, mesh.cells[face.cell][a], Vector<dim>(shares[a] * pull));
  }
  hand_to_masters<dim>(mesh, f);
  return f;
}

template <int dim>
double volume(const Mesh<dim> &mesh)
{
  double sum = 0;
  for (int cell = 0; cell < mesh.n_cells(); ++cell)
    sum += cell_volume(mesh, cell);
  return sum * body<dim>().thickness;
}

template <int dim>
Matrix<dim> stress_of(const Matrix<dim> &gradient)
{
  const Matrix<dim> strain = (gradient + gradient.transpose()) / 2;
  return lambda * strain.trace() * Matrix<dim>::Identity() + 2 * shear * strain;
}

template <int dim>
void set_affine(FemSolver<dim> &solver, const Matrix<dim> &gradient)
{
  for (int i = 0; i < solver.mesh().n_nodes(); ++i)
    set<dim>(solver.displacement, i, Vector<dim>(gradient * solver.mesh().nodes[i]));
}

/// What `force` and `expected` differ by, in units of `scale`.
template <int dim>
double misfit(const Components<dim> &force, const Components<dim> &expected, double scale)
{
  Components<dim> difference = force;
  for (int c = 0; c < dim; ++c)
    for (std::size_t i = 0; i < force[c].size(); ++i)
      difference[c][i] -= expected[c][i];
  return largest<dim>(difference) / scale;
}

// Nodes at 3 m of cells of 0.1 m have strains to 30 times the round-off, forces of 2^dim cells add
// up.
template <int dim>
void check_patch()
{
  int n_hanging = 0;
  for (const auto &mesh : meshes<dim>()) {
    ASSERT_FALSE(mesh.general.empty());
    n_hanging += int(mesh.hanging.size());
    FemSolver<dim> solver(mesh, body<dim>(), {});
    for (int mode = 0; mode < dim * dim; ++mode) {
      Matrix<dim> gradient = Matrix<dim>::Zero();
      gradient(mode / dim, mode % dim) = 1;
      set_affine<dim>(solver, gradient);
      solver.compute_forces(0);
      const Matrix<dim> stress = stress_of<dim>(gradient);
      const Matrix<dim> unit = stress_of<dim>(Matrix<dim>::Identity());
      const double scale = largest<dim>(boundary_forces<dim>(mesh, unit));
      // Forces on the boundary balance what the cells answer with.
      auto expected = boundary_forces<dim>(mesh, stress);
      for (auto &x : expected)
        for (double &value : x)
          value = -value;
      EXPECT_LT(misfit<dim>(solver.force, expected, scale), 1e-12);
      const double energy = volume(mesh) / 2 * stress.cwiseProduct(gradient).sum();
      EXPECT_NEAR(solver.potential_energy(), energy, 1e-12 * volume(mesh));
    }
  }
  EXPECT_GT(n_hanging, 0);
}

/// Rotation by a large angle, uniform stretch in the material's axes: forces are those of the
/// stretch, turned.
template <int dim>
void check_corotated_patch()
{
  Matrix<dim> r = Matrix<dim>::Identity(), stretch = Matrix<dim>::Zero();
  const double angle = 1.1;
  r.template topLeftCorner<2, 2>() << std::cos(angle), -std::sin(angle), std::sin(angle),
      std::cos(angle);
  for (int k = 0; k < dim; ++k)
    stretch(k, k) = 0.02 * (k + 1);
  stretch(0, 1) = stretch(1, 0) = 0.01;
  for (const auto &mesh : meshes<dim>()) {
    FemSolver<dim> solver(mesh, body<dim>(), {});
    solver.set_corotated(true);
    set_affine<dim>(solver, r - Matrix<dim>::Identity());
    solver.compute_forces(0);
    EXPECT_LT(largest<dim>(solver.force), 1e-13);
    EXPECT_LT(solver.potential_energy(), 1e-26 * volume(mesh));
    EXPECT_NEAR(solver.largest_motion().rotation.value, angle, 1e-12);

    set_affine<dim>(solver, r * (Matrix<dim>::Identity() + stretch) - Matrix<dim>::Identity());
    solver.compute_forces(0);
    const Matrix<dim> stress = stress_of<dim>(stretch);
    // First Piola stress of the law: R sigma. Nothing inside, that on the boundary.
    auto expected = boundary_forces<dim>(mesh, stress);
    for (int i = 0; i < mesh.n_nodes(); ++i)
      set<dim>(expected, i, Vector<dim>(-r * get(expected, i)));
    EXPECT_LT(misfit<dim>(solver.force, expected, largest<dim>(expected)), 1e-12);
    EXPECT_NEAR(solver.potential_energy(), volume(mesh) / 2 * stress.cwiseProduct(stretch).sum(),
                1e-13 * volume(mesh));
    EXPECT_NEAR(solver.largest_motion().strain.value, stretch.norm(), 1e-12);
  }
}

/// Against cell after cell, with stiffnesses of each one's own.
template <int dim>
void check_kernel(const Mesh<dim> &mesh, bool has_groups, bool has_singles)
{
  const auto b = body<dim>();
  const CellKernel<dim> kernel(mesh, b,
                               std::vector<char>(mesh.n_cells(), 1));
  EXPECT_EQ(kernel.n_groups() > 0, has_groups);
  EXPECT_EQ(kernel.n_single_cells() > 0, has_singles);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Components<dim> u = zeros(mesh), force = zeros(mesh), expected = zeros(mesh);
  for (auto &values : u)
    for (double &x : values)
      x = uniform(random);
  kernel.subtract_forces(u, force);
  for (int cell = 0; cell < mesh.n_cells(); ++cell) {
    Vec<dim * n_cell_nodes<dim>> own;
    for (int a = 0; a < n_cell_nodes<dim>; ++a)
      own.template segment<dim>(dim * a) = get(u, mesh.cells[cell][a]);
    const Vec<dim * n_cell_nodes<dim>> f =
        cell_stiffness(mesh, cell, b) * own;
    for (int a = 0; a < n_cell_nodes<dim>; ++a)
      add<dim>(expected, mesh.cells[cell][a], Vector<dim>(-f.template segment<dim>(dim * a)));
  }
  EXPECT_LT(misfit<dim>(force, expected, largest<dim>(expected)), 1e-12);
}

template <int dim>
void check_masses()
{
  const Mesh<dim> boxes = make_mesh(graded<dim>());
  EXPECT_NEAR(volume(distorted(boxes, 0.2)), volume(boxes), 1e-12 * volume(boxes));
  EXPECT_NEAR(volume(meshes<dim>()[0]), slant<dim>().determinant() * volume(boxes),
              1e-12 * volume(boxes));
  for (const auto &mesh : meshes<dim>()) {
    const FemSolver<dim> solver(mesh, body<dim>(), {});
    double sum = 0;
    Vector<dim> moment = Vector<dim>::Zero(), expected = Vector<dim>::Zero();
    for (int i = 0; i < mesh.n_nodes(); ++i) {
      EXPECT_GE(solver.lumped_mass()[i], 0);
      sum += solver.lumped_mass()[i];
      moment += solver.lumped_mass()[i] * mesh.nodes[i];
    }
    // int x dV by two points per axis, exact.
    for (int cell = 0; cell < mesh.n_cells(); ++cell) {
      const auto corners = cell_corners(mesh, cell);
      for (int q = 0; q < n_cell_nodes<dim>; ++q) {
        Vector<dim> s;
        for (int k = 0; k < dim; ++k)
          s[k] = 0.5 + (q >> k & 1 ? 0.5 : -0.5) / std::sqrt(3.);
        expected += density * body<dim>().thickness / n_cell_nodes<dim> *
                    cell_jacobian<dim>(corners, s).determinant() * cell_point<dim>(corners, s);
      }
    }
    EXPECT_NEAR(sum, density * volume(mesh), 1e-12 * sum);
    EXPECT_LT((moment - expected).norm(), 1e-12 * sum);
  }
}

/// Stiffness of the free nodes against their lumped mass, densely.
template <int dim>
double largest_frequency(FemSolver<dim> &solver)
{
  const auto &mesh = solver.mesh();
  std::vector<int> free;
  for (int i = 0; i < mesh.n_nodes(); ++i)
    if (solver.lumped_mass()[i] > 0)
      free.push_back(i);
  const int n = int(free.size());
  Eigen::MatrixXd k(dim * n, dim * n);
  for (int column = 0; column < dim * n; ++column) {
    Components<dim> u = zeros(mesh), f = zeros(mesh);
    u[column % dim][free[column / dim]] = 1;
    solver.subtract_stiffness(u, f);
    for (int row = 0; row < dim * n; ++row)
      k(row, column) =
          -f[row % dim][free[row / dim]] / std::sqrt(solver.lumped_mass()[free[row / dim]] *
                                                     solver.lumped_mass()[free[column / dim]]);
  }
  EXPECT_LT((k - k.transpose()).norm(), 1e-12 * k.norm());
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(k, Eigen::EigenvaluesOnly)
                       .eigenvalues()[dim * n - 1]);
}

template <int dim>
void check_stable_step(const MeshParameters<dim> &p)
{
  for (const unsigned seed : {1, 2, 3}) {
    FemSolver<dim> solver(distorted(make_mesh(p), 0.25, seed), body<dim>(), {});
    const double largest_step = 2 / largest_frequency(solver);
    EXPECT_LE(solver.stable_step(), largest_step * (1 + 1e-12));
    EXPECT_GE(solver.stable_step(), 0.5 * largest_step); // one cell of many bounds it
  }
}

template <int dim>
void check_energy(bool corotated)
{
  using Load = core::BoundaryLoad<dim>;
  Load pull, push;
  pull.boundary = 2 * dim - 1;
  pull.kind = Load::Kind::velocity;
  pull.value[dim - 1] = 0.02;
  pull.history = core::Ramp{3};
  push.boundary = 1;
  push.kind = Load::Kind::traction;
  push.value[0] = -0.03;
  push.history = core::Ramp{1};
  FemSolver<dim> solver(distorted(make_mesh(graded<dim>()), 0.2), body<dim>(), {pull, push});
  solver.set_corotated(corotated);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-0.1, 0.1);
  if (!corotated)
    for (auto &v : solver.velocity)
      for (double &x : v)
        x = uniform(random);
  const double dt = (corotated ? 0.05 : 0.95) * solver.stable_step();
  double first = 0, error = 0, most = 0;
  for (int step = 0; step <= 600; ++step) {
    solver.compute_forces(step * dt);
    const double kinetic = solver.kinetic_energy(dt), potential = solver.potential_energy();
    const double energy = kinetic + potential - solver.external_work();
    if (step == 0)
      first = energy;
    keep_largest(error, std::abs(energy - first));
    most = std::max({most, std::abs(kinetic), std::abs(potential)});
    solver.kick(dt, step * dt);
    solver.drift(dt);
  }
  EXPECT_GT(most, 0);
  // Linear: the invariant of leap-frog is exact. Turning: of second order, (omega dt/2)^2 at most.
  EXPECT_LT(error, (corotated ? 0.05 * 0.05 : 1e-12) * most);
}
} // namespace

TEST(GeneralMesh, passes_the_patch_test_in_2d)
{
  check_patch<2>();
}
TEST(GeneralMesh, passes_the_patch_test_in_3d)
{
  check_patch<3>();
}
TEST(GeneralMesh, turns_freely_and_is_stretched_uniformly_when_turned_in_2d)
{
  check_corotated_patch<2>();
}
TEST(GeneralMesh, turns_freely_and_is_stretched_uniformly_when_turned_in_3d)
{
  check_corotated_patch<3>();
}

TEST(GeneralMesh, has_forces_of_its_cells)
{
  const auto all = meshes<2>();
  check_kernel<2>(all[0], true, false); // parallelograms of few shapes
  check_kernel<2>(all[1], false, true); // every cell its own
  check_kernel<2>(all[2], true, true);
  const auto solid = meshes<3>();
  check_kernel<3>(solid[0], true, false);
  check_kernel<3>(solid[2], true, true);
}

TEST(GeneralMesh, has_the_mass_and_its_centre)
{
  check_masses<2>();
  check_masses<3>();
}

TEST(GeneralMesh, is_stable_at_the_bound_of_its_cells)
{
  check_stable_step<2>(box<2>({1, 0.8}, 0.1));
  check_stable_step<3>(box<3>({0.5, 0.4, 0.4}, 0.1));
  MeshParameters<2> graded = ring<2>();
  graded.levels = 1;
  graded.cell_size = 0.2;
  graded.fine_cells = 1;
  check_stable_step<2>(graded);
}

TEST(GeneralMesh, keeps_energy_and_books_the_work_of_loads)
{
  check_energy<2>(false);
  check_energy<3>(false);
}
TEST(GeneralMesh, keeps_energy_where_cells_turn)
{
  check_energy<2>(true);
}
} // namespace ligament::fem
