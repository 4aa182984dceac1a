// Loads on sides of general cells: tractions of a uniform stress, parts of sides, held nodes, and
// numbers of sides beyond those of a box.
#include "core/check.h"
#include "fem/fem_solver.h"
#include "fem/part_shares.h"
#include "tests/support/distorted_meshes.h"
#include "tests/unit/fem/meshes.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ligament::fem
{
namespace
{
constexpr double lambda = 3, shear = 2, thickness = 0.5;
constexpr double inf = std::numeric_limits<double>::infinity();

/// Numbers of the sides of an inclined specimen: those of a box stand for sides along the axes.
template <int dim>
int named(int side)
{
  return inner_surface<dim> + 3 + side;
}

template <int dim>
Body<dim> body()
{
  return {isotropic<dim>(lambda, shear), 0.5, dim == 2 ? thickness : 1};
}

/// A box of unequal cells, inclined; its sides have names.
template <int dim, typename Map>
Mesh<dim> specimen(Map &&map)
{
  const Vector<dim> size = dim == 2 ? Vector<dim>::Constant(1) : Vector<dim>::Constant(0.6);
  Mesh<dim> mesh = mapped(distorted(make_mesh(box<dim>(size, 0.2)), 0.2), map);
  for (auto &face : mesh.boundary_faces)
    face.boundary = named<dim>(face.boundary);
  return mesh;
}

template <int dim>
Mesh<dim> inclined()
{
  return specimen<dim>([](const Vector<dim> &x) -> Vector<dim> { return slant<dim>() * x; });
}

template <int dim>
core::BoundaryLoad<dim> traction(int boundary, const Vector<dim> &value)
{
  core::BoundaryLoad<dim> load;
  load.boundary = boundary;
  load.kind = core::BoundaryLoad<dim>::Kind::traction;
  for (int c = 0; c < dim; ++c)
    load.value[c] = value[c];
  load.history = core::Ramp{0};
  return load;
}

/// Area and first moment of what the part gives to the nodes of a side, without the thickness.
template <int dim>
std::pair<double, Vector<dim>> given(const Mesh<dim> &mesh, const core::Part<dim> &part,
                                     int boundary)
{
  double area = 0;
  Vector<dim> moment = Vector<dim>::Zero();
  for (const auto &face : mesh.boundary_faces)
    if (face.boundary == boundary) {
      const auto shares = part_shares<dim>(part, mesh, face);
      area += shares.sum();
      moment += cell_corners(mesh, face.cell) * shares;
    }
  return {area, moment};
}

/// Tractions of a uniform stress on all sides hold the body that it strains.
template <int dim>
void check_uniform_stress()
{
  const Mesh<dim> mesh = inclined<dim>();
  Eigen::Matrix<double, dim, dim> gradient;
  for (int i = 0; i < dim * dim; ++i)
    gradient.data()[i] = 0.1 * (i % 4) - 0.15 * (i % 3);
  const Eigen::Matrix<double, dim, dim> strain = (gradient + gradient.transpose()) / 2,
                                        stress = lambda * strain.trace() *
                                                     Eigen::Matrix<double, dim, dim>::Identity() +
                                                 2 * shear * strain;
  std::vector<core::BoundaryLoad<dim>> loads;
  for (int side = 0; side < 2 * dim; ++side)
    for (const auto &face : mesh.boundary_faces)
      if (face.boundary == named<dim>(side)) { // plane sides: any face has their normal
        const Vector<dim> normal = face_normal<dim>(cell_corners(mesh, face.cell), face.face);
        loads.push_back(traction<dim>(named<dim>(side), stress * normal));
        break;
      }
  ASSERT_EQ(loads.size(), 2u * dim);
  FemSolver<dim> solver(mesh, body<dim>(), loads);
  for (int i = 0; i < mesh.n_nodes(); ++i)
    set<dim>(solver.displacement, i, Vector<dim>(gradient * mesh.nodes[i]));
  solver.compute_forces(0);
  for (int i = 0; i < mesh.n_nodes(); ++i)
    EXPECT_LT(get(solver.force, i).norm(), 1e-13);
  const double edge = dim == 2 ? 1 : 0.6 * 0.6;
  const Eigen::Matrix<double, dim, dim> s = slant<dim>();
  // Nanson: the area of the side across x.
  const double expected = s.determinant() * s.inverse().transpose().col(0).norm() * edge;
  EXPECT_NEAR(solver.loaded_area(1), expected * body<dim>().thickness, 1e-13);
}
} // namespace

TEST(GeneralLoads, of_a_uniform_stress_are_in_balance_with_it)
{
  check_uniform_stress<2>();
  check_uniform_stress<3>();
}

TEST(GeneralLoads, act_on_exact_parts_of_inclined_sides_in_2d)
{
  const Mesh<2> mesh = inclined<2>();
  // The right side runs from S (1, 0) to S (1, 1).
  const Vector<2> from = slant<2>() * Vector<2>(1, 0), to = slant<2>() * Vector<2>(1, 1);
  const double length = (to - from).norm();
  const double y0 = 0.13, y1 = 0.71;
  const auto at = [&](double y) -> Vector<2> {
    return from + (y - from[1]) / (to[1] - from[1]) * (to - from);
  };
  auto [area, moment] = given<2>(mesh, core::Part<2>::box({-inf, y0}, {inf, y1}), named<2>(1));
  EXPECT_NEAR(area, (at(y1) - at(y0)).norm(), 1e-14);
  EXPECT_LT((moment - area * (at(y0) + at(y1)) / 2).norm(), 1e-14);

  const Vector<2> middle = from + 0.4 * (to - from);
  const Vector<2> across = Vector<2>(to[1] - from[1], from[0] - to[0]) / length;
  std::tie(area, moment) =
      given<2>(mesh, core::Part<2>::ball(middle + 0.12 * across, 0.2), named<2>(1));
  EXPECT_NEAR(area, 2 * std::sqrt(0.2 * 0.2 - 0.12 * 0.12), 1e-14);
  EXPECT_LT((moment - area * middle).norm(), 1e-14);
  std::tie(area, moment) = given<2>(mesh, core::Part<2>(), named<2>(1));
  EXPECT_NEAR(area, length, 1e-14);
  EXPECT_EQ(given<2>(mesh, core::Part<2>::ball({9, 9}, 1), named<2>(1)).first, 0);
}

TEST(GeneralLoads, act_on_parts_of_sides_in_3d)
{
  // Sheared across z alone: the sides across z stay along the axes, their cells are no boxes.
  const Mesh<3> mesh = specimen<3>(
      [](const Vector<3> &x) { return Vector<3>(x[0] + 0.3 * x[1], x[1] - 0.1 * x[0], x[2]); });
  const auto [area, moment] =
      given<3>(mesh, core::Part<3>::box({0.21, 0.07, -inf}, {0.47, 0.33, inf}), named<3>(5));
  EXPECT_NEAR(area, 0.26 * 0.26, 1e-14);
  EXPECT_LT((moment - area * Vector<3>(0.34, 0.2, 0.6)).norm(), 1e-14);

  // Inclined faces count when their centroid is inside.
  const core::Part<3> half = core::Part<3>::box({-inf, -inf, 0.25}, {inf, inf, inf});
  double expected = 0;
  for (const auto &face : mesh.boundary_faces) {
    const auto corners = face_corners<3>(cell_corners(mesh, face.cell), face.face);
    if (face.boundary == named<3>(1) && core::face_centroid<3>(corners)[2] > 0.25)
      expected += core::face_area<3>(corners);
  }
  EXPECT_GT(expected, 0);
  EXPECT_NEAR(given<3>(mesh, half, named<3>(1)).first, expected, 1e-14);
}

TEST(GeneralLoads, hold_the_nodes_of_inclined_sides)
{
  const Mesh<2> mesh = inclined<2>();
  core::BoundaryLoad<2> hold;
  hold.boundary = named<2>(1);
  hold.kind = core::BoundaryLoad<2>::Kind::velocity;
  hold.value[1] = 0.3;
  hold.history = core::Ramp{0};
  FemSolver<2> solver(mesh, body<2>(), {hold});
  EXPECT_EQ(solver.n_held_nodes(0), 6); // five cells of 0.2
  const double dt = solver.stable_step() / 2;
  for (int step = 0; step < 4; ++step) {
    solver.compute_forces(step * dt);
    solver.kick(dt, step * dt);
    solver.drift(dt);
  }
  const Vector<2> from = slant<2>() * Vector<2>(1, 0), to = slant<2>() * Vector<2>(1, 1);
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const Vector<2> x = mesh.nodes[i] - from, along = to - from;
    const bool on_side = std::abs(x[0] * along[1] - x[1] * along[0]) < 1e-12;
    EXPECT_EQ(solver.is_held(i, 1), on_side);
    EXPECT_FALSE(solver.is_held(i, 0));
    EXPECT_TRUE(!on_side || std::abs(solver.displacement[1][i] - 0.3 * 4 * dt) < 1e-14);
  }
}

TEST(GeneralLoads, absorb_on_sides_along_the_axes_alone)
{
  auto load = traction<2>(named<2>(1), Vector<2>::Zero());
  load.absorbing = true;
  EXPECT_THROW(FemSolver<2>(inclined<2>(), body<2>(), {load}), core::InputError);

  // There the dashpots have the impedance of the side, whatever its cells: all of a plane wave
  // goes.
  Mesh<2> mesh = distorted(make_mesh(box<2>({4, 0.4}, 0.1)), 0.2);
  std::vector<core::BoundaryLoad<2>> loads;
  auto absorbing = traction<2>(1, Vector<2>::Zero());
  absorbing.absorbing = true;
  for (const int side : {2, 3}) { // no motion across
    core::BoundaryLoad<2> hold;
    hold.boundary = side;
    hold.value[1] = 0;
    loads.push_back(hold);
  }
  loads.push_back(absorbing);
  FemSolver<2> solver(mesh, body<2>(), loads);
  const double speed = std::sqrt((lambda + 2 * shear) / 0.5), k = 2 * M_PI / 2;
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const double x = mesh.nodes[i][0];
    if (x > 1 && x < 3) { // one wave to the right, smooth at its ends
      solver.displacement[0][i] = 1e-3 * (1 - std::cos(k * (x - 1)));
      solver.velocity[0][i] = -speed * 1e-3 * k * std::sin(k * (x - 1));
    }
  }
  const double dt = 0.8 * solver.stable_step();
  double first = 0;
  for (double time = 0; time < 5 / speed; time += dt) {
    solver.compute_forces(time);
    const double energy = solver.kinetic_energy(dt) + solver.potential_energy();
    if (first == 0)
      first = energy;
    solver.kick(dt, time);
    solver.drift(dt);
  }
  solver.compute_forces(5 / speed);
  // A wave over 20 cells: dispersion and the cells' shapes leave (k h)^2 = 0.1 of its amplitude.
  EXPECT_LT(solver.kinetic_energy(dt) + solver.potential_energy(), 0.01 * first);
  EXPECT_GT(first, 0);
}
} // namespace ligament::fem
