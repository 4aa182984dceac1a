// Lattices and specimens of the packing tests, and the closure of cells.
#pragma once

#include "core/extremes.h"
#include "packings/lattice_packing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ligament::packings::test
{
template <int dim>
using Matrix = Eigen::Matrix<double, dim, dim>;

struct LatticeValues
{
  LatticeKind kind;
  int neighbours;
  double area, volume; // for d = 1: theory.md table of packings
};

inline const LatticeValues square{LatticeKind::square, 4, 1, 1};
inline const LatticeValues hexagonal{LatticeKind::hexagonal, 6, 1 / std::sqrt(3.),
                                     std::sqrt(3.) / 2};
inline const LatticeValues simple_cubic{LatticeKind::simple_cubic, 6, 1, 1};
inline const LatticeValues fcc{LatticeKind::fcc, 12, 1 / std::sqrt(8.), 1 / std::sqrt(2.)};

/// A specimen that fits the lattice in no direction, far from the origin.
template <int dim>
LatticeParameters<dim> specimen(LatticeKind kind, double size)
{
  LatticeParameters<dim> p;
  p.kind = kind;
  p.spacing = 0.01;
  p.thickness = 0.3;
  const std::array<double, 3> shape = {1, 0.83, 0.71};
  for (int a = 0; a < dim; ++a) {
    p.lower[a] = 0.7 - 0.4 * a;
    p.upper[a] = p.lower[a] + size * p.spacing * shape[a];
  }
  return p;
}

template <int dim>
double box_volume(const LatticeParameters<dim> &p)
{
  return (p.upper - p.lower).prod() * (dim == 2 ? p.thickness : 1);
}

/// Largest violation of (D2a) over S d^0 and of (D2b) over V, of the cells with `check[i]`; also
/// checks that q, levers, normals and order agree.
template <int dim>
double closure_error(const Packing<dim> &packing, const std::vector<char> &check = {})
{
  const int n = packing.size();
  std::vector<Vector<dim>> surface(n, Vector<dim>::Zero());
  std::vector<Matrix<dim>> moment(n, Matrix<dim>::Zero());
  const double d = packing.spacing;
  for (std::size_t f = 0; f < packing.faces.size(); ++f) {
    const auto &face = packing.faces[f];
    if (f > 0) {
      const auto &last = packing.faces[f - 1];
      EXPECT_TRUE(last.i < face.i || (last.i == face.i && last.j < face.j));
      EXPECT_TRUE(last.i < face.i || face.direction < 0 || last.direction < face.direction);
    }
    EXPECT_LT(face.i, face.j);
    EXPECT_GT(face.area, 0);
    const Vector<dim> r = get(packing.centre, face.j) - get(packing.centre, face.i);
    const double scale = get(packing.centre, face.i).norm();
    EXPECT_NEAR((r - (face.q_i + face.q_j) * face.normal).norm(), 0, 4e-16 * scale);
    EXPECT_NEAR((face.lever_i - face.lever_j - r).norm(), 0, 4e-16 * scale);
    if (face.area > 1e-6 * std::pow(d, dim - 1) * packing.thickness) {
      EXPECT_NEAR(face.lever_i.dot(face.normal), face.q_i, 1e-9 * d);
    }
    surface[face.i] += face.area * face.normal;
    surface[face.j] -= face.area * face.normal;
    moment[face.i] += face.area * face.lever_i * face.normal.transpose();
    moment[face.j] -= face.area * face.lever_j * face.normal.transpose();
  }
  for (const auto &face : packing.boundary_faces) {
    EXPECT_GT(face.area, 0);
    surface[face.i] += face.area * face.normal;
    moment[face.i] += face.area * face.lever * face.normal.transpose();
  }
  double error = 0;
  for (int i = 0; i < n; ++i)
    if (check.empty() || check[i]) {
      keep_largest(error, surface[i].norm() * d / packing.volume[i]);
      keep_largest(error, (moment[i] / packing.volume[i] - Matrix<dim>::Identity()).norm());
    }
  return error;
}

template <int dim>
double total_volume(const Packing<dim> &packing)
{
  double sum = 0;
  for (const double v : packing.volume)
    sum += v;
  return sum;
}

template <int dim>
std::vector<Spin<dim>> orientations()
{
  if constexpr (dim == 2)
    return {Spin<2>(0), Spin<2>(M_PI / 12), Spin<2>(M_PI / 2), Spin<2>(-0.7)};
  else
    return {Spin<3>(0, 0, 0), Spin<3>(0, 0, M_PI / 12), Spin<3>(0.3, -1.1, 0.7)};
}

/// What round-off allows: positions carry eps |x|, a cell that is clipped there errs by that over
/// d, times the number of faces and the size of slivers.
template <int dim>
double round_off(const LatticeParameters<dim> &p)
{
  return 100 * std::numeric_limits<double>::epsilon() * std::max(p.lower.norm(), p.upper.norm()) /
         p.spacing;
}
} // namespace ligament::packings::test
