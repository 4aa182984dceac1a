// The finite solver: forces against formulas and a naive sum, loads, released cells.
#include "core/check.h"
#include "core/extremes.h"
#include "fem/fem_solver.h"
#include "tests/unit/fem/meshes.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
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

template <int dim>
std::vector<MeshParameters<dim>> graded_meshes()
{
  return {band<dim>(), ring<dim>(), incommensurate(ring<dim>())};
}

template <int dim>
FemSolver<dim> unloaded(const MeshParameters<dim> &p)
{
  return FemSolver<dim>(make_mesh(p), body<dim>(), {});
}

template <int dim>
void set_affine(FemSolver<dim> &solver, const Eigen::Matrix<double, dim, dim> &gradient)
{
  for (int i = 0; i < solver.mesh().n_nodes(); ++i)
    set<dim>(solver.displacement, i, Vector<dim>(gradient * solver.mesh().nodes[i]));
}

template <int dim>
void set_random(FemSolver<dim> &solver)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (auto &u : solver.displacement)
    for (double &x : u)
      x = uniform(random);
  solver.distribute();
}

template <int dim>
double volume(const Mesh<dim> &mesh)
{
  double sum = 0;
  for (const auto &h : mesh.cell_size)
    sum += h.prod();
  return sum * body<dim>().thickness;
}

/// The largest component of `a` + factor * `b` over all nodes.
template <int dim>
double largest(const Components<dim> &a, double factor = 0, const Components<dim> &b = {})
{
  double x = 0;
  for (int c = 0; c < dim; ++c)
    for (std::size_t i = 0; i < a[c].size(); ++i)
      keep_largest(x, std::abs(a[c][i] + (factor != 0 ? factor * b[c][i] : 0)));
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

/// Forces of a constant stress: what its traction does on all faces of the boundary.
template <int dim>
Components<dim> boundary_forces(const Mesh<dim> &mesh, const Strain<dim> &stress)
{
  Components<dim> f;
  for (auto &x : f)
    x.assign(mesh.n_nodes(), 0.);
  for (const auto &face : mesh.boundary_faces) {
    const int k = face.face / 2;
    const auto &h = mesh.cell_size[face.cell];
    const double area = h.prod() / h[k] * body<dim>().thickness / (n_cell_nodes<dim> / 2);
    Vector<dim> traction;
    for (int c = 0; c < dim; ++c)
      traction[c] = (face.face % 2 ? 1 : -1) * stress[c == k ? c : dim == 2 ? 2 : 6 - c - k];
    for (int a = 0; a < n_cell_nodes<dim>; ++a)
      if ((a >> k & 1) == face.face % 2)
        add<dim>(f, mesh.cells[face.cell][a], Vector<dim>(area * traction));
  }
  hand_to_masters<dim>(mesh, f);
  return f;
}

template <int dim>
Strain<dim> strain_of(const Eigen::Matrix<double, dim, dim> &a)
{
  Strain<dim> e;
  if constexpr (dim == 2)
    e << a(0, 0), a(1, 1), a(0, 1) + a(1, 0);
  else
    e << a(0, 0), a(1, 1), a(2, 2), a(1, 2) + a(2, 1), a(0, 2) + a(2, 0), a(0, 1) + a(1, 0);
  return e;
}

template <int dim>
void check_patch()
{
  for (const auto &p : graded_meshes<dim>()) {
    auto solver = unloaded(p);
    for (int mode = 0; mode < dim * dim; ++mode) {
      Eigen::Matrix<double, dim, dim> gradient = Eigen::Matrix<double, dim, dim>::Zero();
      gradient(mode / dim, mode % dim) = 1;
      set_affine<dim>(solver, gradient);
      solver.compute_forces(0);
      const Strain<dim> strain = strain_of<dim>(gradient);
      const Strain<dim> stress = body<dim>().stiffness * strain;
      // Unit strain; round-off grows with u, which is up to 30 h here.
      const double scale = (lambda + 2 * shear) * std::pow(p.cell_size, dim - 1);
      EXPECT_LT(largest<dim>(solver.force, -1, boundary_forces<dim>(solver.mesh(), -stress)),
                1e-13 * scale)
          << "mode " << mode;
      const double energy = strain.dot(stress) / 2 * volume(solver.mesh());
      EXPECT_NEAR(solver.potential_energy(), energy, 1e-12 * energy);
    }
  }
}

template <int dim>
void check_rigid_motion()
{
  auto solver = unloaded(ring<dim>());
  Eigen::Matrix<double, dim, dim> spin = Eigen::Matrix<double, dim, dim>::Zero();
  spin(0, 1) = 1;
  spin(1, 0) = -1;
  set_affine<dim>(solver, spin);
  for (auto &u : solver.displacement)
    for (double &x : u)
      x += 1;
  solver.compute_forces(0);
  const double c11h = (lambda + 2 * shear) * std::pow(0.1, dim - 1);
  EXPECT_LT(largest<dim>(solver.force), 1e-13 * c11h);
  EXPECT_LT(std::abs(solver.potential_energy()),
            1e-13 * (lambda + 2 * shear) * volume(solver.mesh()));
}

template <int dim>
void check_against_naive_sum()
{
  for (const auto &p : {band<dim>(), incommensurate(ring<dim>())}) {
    auto solver = unloaded(p);
    set_random(solver);
    solver.compute_forces(0);
    const Mesh<dim> &mesh = solver.mesh();
    Components<dim> f;
    for (auto &x : f)
      x.assign(mesh.n_nodes(), 0.);
    double energy = 0;
    for (int cell = 0; cell < mesh.n_cells(); ++cell) {
      Vec<dim * n_cell_nodes<dim>> u;
      for (int a = 0; a < n_cell_nodes<dim>; ++a)
        u.template segment<dim>(dim * a) = get(solver.displacement, mesh.cells[cell][a]);
      const Vec<dim * n_cell_nodes<dim>> r =
          cell_stiffness<dim>(mesh.cell_size[cell], body<dim>().stiffness, body<dim>().thickness) *
          u;
      energy += u.dot(r) / 2;
      for (int a = 0; a < n_cell_nodes<dim>; ++a)
        add<dim>(f, mesh.cells[cell][a], Vector<dim>(-r.template segment<dim>(dim * a)));
    }
    hand_to_masters<dim>(mesh, f);
    EXPECT_LT(largest<dim>(solver.force, -1, f), 1e-13 * largest<dim>(f));
    EXPECT_NEAR(solver.potential_energy(), energy, 1e-13 * energy);
  }
}

template <int dim>
void check_released_cells()
{
  auto whole = unloaded(ring<dim>()), own = unloaded(ring<dim>()), rest = unloaded(ring<dim>());
  const Mesh<dim> &mesh = whole.mesh();
  std::vector<int> released, kept;
  for (int c = 0; c < mesh.n_cells(); ++c)
    (mesh.cell_lower[c][1] > -0.65 && mesh.cell_lower[c][0] < 1.25 ? released : kept).push_back(c);
  own.release_cells(released);
  rest.release_cells(kept);
  for (auto *solver : {&whole, &own, &rest}) {
    set_random(*solver);
    solver->compute_forces(0);
  }
  Components<dim> sum = own.force;
  double mass = 0;
  std::vector<char> touched(mesh.n_nodes(), 0);
  for (const int c : released)
    for (const int node : mesh.cells[c])
      touched[node] = 1;
  for (const auto &h : mesh.hanging) // masters move with the hanging corners of released cells
    for (const auto &[master, weight] : h.masters)
      touched[master] |= touched[h.node];
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    add<dim>(sum, i, get(rest.force, i));
    const double m = whole.lumped_mass()[i];
    EXPECT_NEAR(own.lumped_mass()[i] + rest.lumped_mass()[i], m, 1e-14 * m);
    EXPECT_EQ(own.is_released_node(i), touched[i]);
    mass += m;
  }
  EXPECT_LT(largest<dim>(sum, -1, whole.force), 1e-14 * largest<dim>(whole.force));
  EXPECT_NEAR(own.potential_energy() + rest.potential_energy(), whole.potential_energy(),
              1e-13 * whole.potential_energy());
  EXPECT_NEAR(mass, density * volume(mesh), 1e-12 * mass);

  // Released nodes stay where their coupler puts them.
  const auto before = own.displacement;
  own.kick(1e-6, 0);
  own.drift(1e-6);
  std::vector<char> hanging(mesh.n_nodes(), 0);
  for (const auto &h : mesh.hanging)
    hanging[h.node] = 1;
  for (int i = 0; i < mesh.n_nodes(); ++i)
    if (!hanging[i]) {
      EXPECT_EQ(get(own.displacement, i) == get(before, i), own.is_released_node(i));
    }
}

template <int dim>
core::BoundaryLoad<dim> load(int boundary, typename core::BoundaryLoad<dim>::Kind kind,
                             int component, double value, double ramp)
{
  core::BoundaryLoad<dim> l;
  l.boundary = boundary;
  l.kind = kind;
  l.value[component] = value;
  l.history = core::Ramp{ramp};
  return l;
}

template <int dim>
void check_uniaxial_stress()
{
  using Kind = typename core::BoundaryLoad<dim>::Kind;
  const double sigma = 1e6;
  const auto p = band<dim>();
  FemSolver<dim> solver(
      make_mesh(p), body<dim>(),
      {load<dim>(0, Kind::displacement, 0, 0, 0), load<dim>(1, Kind::traction, 0, sigma, 1)});
  Strain<dim> stress = Strain<dim>::Zero();
  stress[0] = sigma / 2;
  const Strain<dim> strain = body<dim>().stiffness.inverse() * stress;
  Eigen::Matrix<double, dim, dim> gradient = strain.template head<dim>().asDiagonal();
  set_affine<dim>(solver, gradient);
  for (double &u : solver.displacement[0])
    u -= strain[0] * p.lower[0];
  solver.compute_forces(0.5); // half way up the ramp
  double area = body<dim>().thickness;
  for (int k = 1; k < dim; ++k)
    area *= p.upper[k] - p.lower[k];
  area *= 1 - (p.inner[0].upper[dim - 1] - p.inner[0].lower[dim - 1]) /
                  (p.upper[dim - 1] - p.lower[dim - 1]);
  EXPECT_NEAR(solver.reaction(0)[0], -sigma / 2 * area, 1e-12 * sigma * area);
  EXPECT_NEAR(solver.reaction(1)[0], sigma / 2 * area, 1e-12 * sigma * area);
  const double scale = (lambda + 2 * shear) * strain[0] * std::pow(p.cell_size, dim - 1);
  for (int i = 0; i < solver.mesh().n_nodes(); ++i)
    for (int c = 0; c < dim; ++c) {
      EXPECT_EQ(solver.is_held(i, c),
                c == 0 && solver.mesh().nodes[i][0] == p.lower[0] && solver.lumped_mass()[i] > 0);
      if (!solver.is_held(i, c)) {
        EXPECT_NEAR(solver.force[c][i], 0, 1e-12 * scale);
      }
    }
}

template <int dim>
void check_held_components_follow_their_load()
{
  using Kind = typename core::BoundaryLoad<dim>::Kind;
  const double v0 = 3, u0 = 0.2, ramp = 1e-4;
  FemSolver<dim> solver(make_mesh(band<dim>()), body<dim>(),
                        {load<dim>(2 * dim - 1, Kind::velocity, dim - 1, v0, ramp),
                         load<dim>(2 * dim - 2, Kind::displacement, 0, u0, ramp)});
  core::Ramp f{ramp};
  const double dt = 0.9 * solver.stable_step();
  double time = 0;
  for (int step = 0; step < 20; ++step) {
    solver.compute_forces(time);
    solver.kick(dt, time);
    solver.drift(dt);
    time += dt;
  }
  int n_held[2] = {0, 0};
  for (int i = 0; i < solver.mesh().n_nodes(); ++i) {
    if (solver.is_held(i, dim - 1)) {
      ++n_held[0];
      EXPECT_NEAR(solver.displacement[dim - 1][i], v0 * f.integral(time), 1e-14);
    }
    if (solver.is_held(i, 0)) {
      ++n_held[1];
      EXPECT_NEAR(solver.displacement[0][i], u0 * f.value(time), 1e-14);
    }
  }
  EXPECT_GT(n_held[0], 0);
  EXPECT_GT(n_held[1], 0);

  const auto before = solver.velocity;
  solver.scale_velocities(0.5);
  for (int c = 0; c < dim; ++c)
    for (int i = 0; i < solver.mesh().n_nodes(); ++i)
      EXPECT_EQ(solver.velocity[c][i], (solver.is_held(i, c) ? 1 : 0.5) * before[c][i]);
}

template <int dim>
double momentum(const FemSolver<dim> &solver, int component)
{
  double sum = 0;
  for (int i = 0; i < solver.mesh().n_nodes(); ++i)
    sum += solver.lumped_mass()[i] * solver.velocity[component][i];
  return sum;
}

/// Newton's law for the whole body under mass damping: the support carries inertia and drag of all
/// nodes, its own included.
template <int dim>
void check_supports_carry_what_they_hold()
{
  using Kind = typename core::BoundaryLoad<dim>::Kind;
  const double v0 = 3, ramp = 1e-3;
  FemSolver<dim> solver(make_mesh(band<dim>()), body<dim>(),
                        {load<dim>(2 * dim - 1, Kind::velocity, dim - 1, v0, ramp)});
  const double dt = 0.9 * solver.stable_step(), rate = 0.1 / dt;
  solver.set_mass_damping(rate);
  double time = 0, largest = 0, error = 0;
  for (int step = 0; step < 40; ++step, time += dt) {
    solver.compute_forces(time);
    const double before = momentum(solver, dim - 1), load = solver.reaction(0)[dim - 1];
    solver.damp_velocities(dt);
    solver.kick(dt, time);
    solver.damp_velocities(-dt);
    const double growth = std::exp(rate * dt / 2);
    const double needed = (momentum(solver, dim - 1) * growth - before / growth) / dt;
    if (step > 0) {
      keep_largest(error, std::abs(load - needed));
      keep_largest(largest, std::abs(needed));
    }
    solver.drift(dt);
  }
  EXPECT_LT(error, 1e-11 * largest);
  EXPECT_GT(largest, 0);
}

/// A side that moves at once gives its nodes their kinetic energy by an impulse, which is work.
template <int dim>
void check_motion_that_jumps()
{
  using Kind = typename core::BoundaryLoad<dim>::Kind;
  const double v0 = 3;
  FemSolver<dim> solver(make_mesh(band<dim>()), body<dim>(),
                        {load<dim>(2 * dim - 1, Kind::velocity, dim - 1, v0, 0)});
  const double dt = 0.9 * solver.stable_step();
  double held_mass = 0;
  for (int i = 0; i < solver.mesh().n_nodes(); ++i)
    held_mass += solver.is_held(i, dim - 1) * solver.lumped_mass()[i];
  solver.compute_forces(0);
  EXPECT_EQ(solver.reaction(0).norm(), 0);
  solver.kick(dt, 0);
  EXPECT_NEAR(solver.external_work() / (held_mass * v0 * v0 / 2), 1, 1e-14);
  solver.drift(dt);
  solver.compute_forces(dt);
  EXPECT_NEAR(solver.kinetic_energy(dt) / (held_mass * v0 * v0 / 2), 1, 1e-12);
}

/// A displacement that comes at once is no load: what it leaves behind is the internal force.
template <int dim>
void check_displacement_that_jumps()
{
  using Kind = typename core::BoundaryLoad<dim>::Kind;
  FemSolver<dim> jumps(make_mesh(band<dim>()), body<dim>(),
                       {load<dim>(2 * dim - 1, Kind::displacement, dim - 1, 1e-3, 0)});
  const double dt = 0.9 * jumps.stable_step();
  jumps.compute_forces(0);
  jumps.kick(dt, 0);
  jumps.drift(dt);
  FemSolver<dim> still = unloaded<dim>(band<dim>());
  still.displacement = jumps.displacement;
  still.compute_forces(dt);
  jumps.compute_forces(dt);
  double internal = 0, size = 0;
  for (int i = 0; i < still.mesh().n_nodes(); ++i)
    if (jumps.is_held(i, dim - 1)) {
      internal -= still.force[dim - 1][i];
      size += std::abs(still.force[dim - 1][i]);
    }
  EXPECT_GT(size, 0);
  EXPECT_NEAR(jumps.reaction(0)[dim - 1], internal, 1e-12 * size);
}
} // namespace

TEST(FemSolver, constant_strain_in_2d)
{
  check_patch<2>();
}
TEST(FemSolver, constant_strain_in_3d)
{
  check_patch<3>();
}
TEST(FemSolver, rigid_motion)
{
  check_rigid_motion<2>();
  check_rigid_motion<3>();
}
TEST(FemSolver, agrees_with_the_naive_sum_over_cells)
{
  check_against_naive_sum<2>();
  check_against_naive_sum<3>();
}
TEST(FemSolver, released_cells_and_the_rest_add_up)
{
  check_released_cells<2>();
  check_released_cells<3>();
}
TEST(FemSolver, cells_that_carry_a_traction_cannot_be_released)
{
  using Kind = core::BoundaryLoad<2>::Kind;
  const Mesh<2> mesh = make_mesh(band<2>());
  const auto release = [&](const CellFace<2> &face, int loaded) {
    FemSolver<2> solver(mesh, body<2>(), {load<2>(loaded, Kind::traction, 0, 1e6, 1)});
    solver.release_cells({face.cell});
  };
  for (const int boundary : {2, 3}) {
    const auto face = std::find_if(mesh.boundary_faces.begin(), mesh.boundary_faces.end(),
                                   [&](const auto &f) { return f.boundary == boundary; });
    ASSERT_NE(face, mesh.boundary_faces.end());
    EXPECT_THROW(release(*face, boundary), core::InputError);
    EXPECT_NO_THROW(release(*face, 5 - boundary)); // the opposite side
  }
}
TEST(FemSolver, uniaxial_stress)
{
  check_uniaxial_stress<2>();
  check_uniaxial_stress<3>();
}
TEST(FemSolver, held_components_follow_their_load)
{
  check_held_components_follow_their_load<2>();
  check_held_components_follow_their_load<3>();
}
TEST(FemSolver, supports_carry_what_they_hold)
{
  check_supports_carry_what_they_hold<2>();
  check_supports_carry_what_they_hold<3>();
}
TEST(FemSolver, motions_that_jump)
{
  check_motion_that_jumps<2>();
  check_motion_that_jumps<3>();
  check_displacement_that_jumps<2>();
  check_displacement_that_jumps<3>();
}

TEST(FemSolver, stable_step_of_square_and_cubic_cells)
{
  // The breathing mode governs: omega^2 = 4 (dim lambda + 2 G)/(rho h^2) for one cell.
  const double h = 0.1;
  EXPECT_NEAR(FemSolver<2>(make_mesh(box<2>({1, 1}, h)), body<2>(), {}).stable_step(),
              h * std::sqrt(density / (2 * lambda + 2 * shear)), 1e-12 * h);
  EXPECT_NEAR(FemSolver<3>(make_mesh(box<3>({1, 1, 1}, h)), body<3>(), {}).stable_step(),
              h * std::sqrt(density / (3 * lambda + 2 * shear)), 1e-12 * h);
}
} // namespace ligament::fem
