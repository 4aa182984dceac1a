// Meshes of general cells alone: a hole with cells around it against Kirsch, and what bending loses
// on cells out of shape.
#include "src/verification/cases/lab_general_cells.h"
#include "core/extremes.h"

#include "algebra/conjugate_gradients.h"
#include "fem/cell_map.h"
#include "fem/cell_quality.h"
#include "fem/fem_solver.h"
#include "src/verification/bodies/kirsch_field.h"

#include <cmath>
#include <functional>
#include <random>

namespace ligament::program
{
namespace
{
constexpr double shear = 1, nu = 0.3; // plane strain
using Field = std::function<Vector<2>(const Vector<2> &)>;

Stiffness<2> plane_strain()
{
  const double lambda = 2 * shear * nu / (1 - 2 * nu);
  Stiffness<2> c;
  c << lambda + 2 * shear, lambda, 0, lambda, lambda + 2 * shear, 0, 0, 0, shear;
  return c;
}

/// Equilibrium with the nodes of one boundary where `exact` has them.
fem::FemSolver<2> solve(const fem::Mesh<2> &mesh, int held_boundary, const Field &exact)
{
  fem::FemSolver<2> far(mesh, {plane_strain(), 1, 1}, {});
  const int n = mesh.n_nodes();
  std::vector<char> is_held(n, 0);
  for (const auto &face : mesh.boundary_faces)
    if (face.boundary == held_boundary)
      for (const int a : fem::face_nodes<2>(face.face))
        is_held[mesh.cells[face.cell][a]] = 1;
  const auto apply = [&](const Eigen::VectorXd &x, Eigen::VectorXd &y) {
    Components<2> u, f;
    for (int c = 0; c < 2; ++c) {
      u[c].assign(x.data() + c * n, x.data() + (c + 1) * n);
      f[c].assign(n, 0.);
    }
    far.subtract_stiffness(u, f);
    y.resize(2 * n);
    for (int i = 0; i < 2 * n; ++i)
      y[i] = is_held[i % n] ? 0 : -f[i / n][i % n];
  };
  Eigen::VectorXd held = Eigen::VectorXd::Zero(2 * n), right, x;
  for (int i = 0; i < n; ++i)
    if (is_held[i]) {
      const Vector<2> u = exact(mesh.nodes[i]);
      held[i] = u[0];
      held[n + i] = u[1];
    }
  apply(held, right);
  right = -right;
  const auto keep = [](Eigen::VectorXd &) {};
  const auto copy = [](const Eigen::VectorXd &r, Eigen::VectorXd &z) { z = r; };
  algebra::conjugate_gradients(apply, copy, keep, keep, right, x, 1e-12 * right.norm(), 20 * n);
  x += held;
  for (int c = 0; c < 2; ++c)
    far.displacement[c].assign(x.data() + c * n, x.data() + (c + 1) * n);
  return far;
}

/// Stress (xx, yy, xy) of a gradient of displacement.
Vector<3> stress_of(const Eigen::Matrix2d &h)
{
  return plane_strain() * Vector<3>(h(0, 0), h(1, 1), h(0, 1) + h(1, 0));
}

/// Around a hole of radius 1, out to a square of half width 2.5: so many cells along each side of
/// the square, radii that grow outwards.
fem::Mesh<2> mesh_around_hole(int along_side)
{
  const int around = 4 * along_side, rings = along_side;
  fem::Mesh<2> mesh;
  for (int k = 0; k < around; ++k) {
    const double angle = 2 * M_PI * (k + 0.5 * along_side) / around;
    const Vector<2> ray(std::cos(angle), std::sin(angle));
    const double part = 2. * (k % along_side) / along_side - 1; // along a side of the square
    Vector<2> outer(-part, 1);
    for (int turn = 0; turn < k / along_side; ++turn)
      outer = Vector<2>(-outer[1], outer[0]);
    for (int i = 0; i <= rings; ++i) {
      const double t = double(i) / rings, out = t * (1 + t) / 2;
      mesh.nodes.push_back((1 - out) * ray + out * 2.5 * outer);
    }
  }
  const auto node = [&](int i, int k) { return (k % around) * (rings + 1) + i; };
  for (int k = 0; k < around; ++k)
    for (int i = 0; i < rings; ++i) {
      mesh.cells.push_back({node(i, k), node(i + 1, k), node(i, k + 1), node(i + 1, k + 1)});
      mesh.cell_level.push_back(0);
      if (i == 0)
        mesh.boundary_faces.push_back({mesh.n_cells() - 1, 0, inner_surface<2>});
      if (i == rings - 1)
        mesh.boundary_faces.push_back({mesh.n_cells() - 1, 1, inner_surface<2> + 1});
    }
  fem::find_cell_shapes(mesh);
  return mesh;
}

struct HoleErrors
{
  double displacement = 0; // over the largest at the rim
  double stress = 0;       // of the cells at the rim, over the largest of the plate
};

HoleErrors hole_errors(int along_side)
{
  const KirschField field{1, shear, nu};
  const Field exact = [&](const Vector<2> &x) -> Vector<2> { return field(x).head<2>(); };
  const auto far = solve(mesh_around_hole(along_side), inner_surface<2> + 1, exact);
  const auto &mesh = far.mesh();
  HoleErrors e;
  for (int i = 0; i < mesh.n_nodes(); ++i)
    e.displacement =
        std::max(e.displacement, (get(far.displacement, i) - exact(mesh.nodes[i])).norm());
  e.displacement /= exact({1, 0}).norm();
  for (const auto &face : mesh.boundary_faces) {
    if (face.boundary != inner_surface<2>)
      continue;
    const auto gradient = fem::centre_gradients(mesh, face.cell);
    Eigen::Matrix2d h = Eigen::Matrix2d::Zero(), expected;
    for (int a = 0; a < 4; ++a)
      h += get(far.displacement, mesh.cells[face.cell][a]) * gradient.col(a).transpose();
    const Vector<2> x =
        fem::cell_point<2>(fem::cell_corners(mesh, face.cell), fem::cell_centre<2>());
    for (int c = 0; c < 2; ++c) {
      const Vector<2> step = 1e-4 * Vector<2>::Unit(c); // fourth order: 1e-12
      expected.col(c) =
          (8 * (exact(x + step) - exact(x - step)) - (exact(x + 2 * step) - exact(x - 2 * step))) /
          (12 * 1e-4);
    }
    keep_largest(e.stress, (stress_of(h) - stress_of(expected)).norm() / 3);
  }
  return e;
}

/// A beam of 8 x 1 in pure bending, its ends where theory has them: largest error over the largest
/// deflection. Inner nodes are moved by up to `share` of a cell.
double bending_error(int across, double share, unsigned seed)
{
  const int along = 8 * across;
  const double h = 1. / across, ratio = nu / (1 - nu);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-share * h, share * h);
  fem::Mesh<2> mesh;
  for (int k = 0; k <= across; ++k)
    for (int i = 0; i <= along; ++i) {
      const Vector<2> moved(uniform(random), uniform(random));
      const bool inside = i > 0 && i < along && k > 0 && k < across;
      mesh.nodes.push_back(Vector<2>(h * i - 4, h * k - 0.5) + (inside ? moved : moved * 0));
    }
  const auto node = [&](int i, int k) { return k * (along + 1) + i; };
  for (int k = 0; k < across; ++k)
    for (int i = 0; i < along; ++i) {
      mesh.cells.push_back({node(i, k), node(i + 1, k), node(i, k + 1), node(i + 1, k + 1)});
      mesh.cell_level.push_back(0);
      if (i == 0 || i == along - 1)
        mesh.boundary_faces.push_back({mesh.n_cells() - 1, i == 0 ? 0 : 1, 0});
    }
  fem::find_cell_shapes(mesh);
  const Field exact = [&](const Vector<2> &x) -> Vector<2> {
    return {x[0] * x[1], -(x[0] * x[0] + ratio * x[1] * x[1]) / 2};
  };
  const auto far = solve(mesh, 0, exact);
  double error = 0;
  for (int i = 0; i < mesh.n_nodes(); ++i)
    keep_largest(error, (get(far.displacement, i) - exact(mesh.nodes[i])).norm());
  return error / 8;
}

/// The mean over eight meshes.
double mean_bending_error(int across)
{
  double sum = 0;
  for (unsigned seed = 1; seed <= 8; ++seed)
    sum += bending_error(across, 0.2, seed);
  return sum / 8;
}

std::vector<Result> measure(const std::string &name)
{
  using Bound = Result::Bound;
  const HoleErrors coarse = hole_errors(12), fine = hole_errors(24);
  const double bent = mean_bending_error(4), bent_fine = mean_bending_error(8);
  // Second order: four times less at half the cell size.
  return {{name + "/hole_displacement", fine.displacement, 0.01, {}},
          {name + "/hole_stress", fine.stress, 0.01, {}},
          {name + "/hole_displacement_gain",
           coarse.displacement / fine.displacement,
           3,
           {},
           Bound::at_least},
          {name + "/hole_stress_gain", coarse.stress / fine.stress, 3, {}, Bound::at_least},
          {name + "/bending_of_boxes", bending_error(4, 0, 1), 1e-9, {}},
          {name + "/bending", bent_fine, 0.01, {}},
          {name + "/bending_gain", bent / bent_fine, 3, {}, Bound::at_least}};
}
} // namespace

std::vector<Case> lab_general_cells_cases()
{
  return {{"lab_general_cells", "cells around a hole against Kirsch, and out of shape in bending",
           false, [] { return measure("lab_general_cells"); }}};
}
} // namespace ligament::program
