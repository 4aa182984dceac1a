// A linear cell that turns with its material: stiffness in axes of the cell's mean rotation.
#pragma once

#include "core/polar_rotation.h"
#include "fem/cell_map.h"

namespace ligament::fem
{
/// What the motion of a cell needs of its shape: corners from the centre in m, gradients of the
/// shape functions there in 1/m (of a box the mean ones).
template <int dim>
struct CellShape
{
  CellVectors<dim> corner, gradient;

  CellShape() = default;
  explicit CellShape(const Vector<dim> &size)
      : gradient(shape_gradients<dim>(Vector<dim>::Zero(), size, size / 2))
  {
    for (int a = 0; a < n_cell_nodes<dim>; ++a)
      corner.col(a) = fem::corner<dim>(size, a) - size / 2;
  }
  /// Of any convex cell; its corners in m.
  explicit CellShape(const CellVectors<dim> &corners)
      : corner(corners.colwise() - cell_point<dim>(corners, cell_centre<dim>())),
        gradient(shape_gradients_at<dim>(corners, cell_centre<dim>()))
  {
  }
};

/// Energy 1/2 u_R . K u_R in J, u_R = R^T x - X, R the rotation of the mean gradient of x = X + u
/// (theory.md eq. (F6)); forces (minus its derivative, in N) into `force`. Displacements u in m.
template <int dim>
double corotated_cell(const CellMatrix<dim> &stiffness, const CellShape<dim> &shape,
                      const CellVectors<dim> &u, CellVectors<dim> &force)
{
  using Matrix = Eigen::Matrix<double, dim, dim>;
  constexpr int nc = n_cell_nodes<dim>;
  const core::PolarRotation<dim> polar(Matrix::Identity() + u * shape.gradient.transpose());
  const Matrix &r = polar.matrix();
  const Vector<dim> mean = u.rowwise().mean();
  const CellVectors<dim> turned =
      r.transpose() * (u.colwise() - mean) + (r.transpose() - Matrix::Identity()) * shape.corner;
  CellVectors<dim> f;
  Eigen::Map<Vec<dim * nc>> flat(f.data());
  flat.noalias() = stiffness * Eigen::Map<const Vec<dim * nc>>(turned.data());
  Spin<dim> torque = Spin<dim>::Zero();
  for (int a = 0; a < nc; ++a)
    torque += core::moment(Vector<dim>(shape.corner.col(a) + turned.col(a)), Vector<dim>(f.col(a)));
  const Spin<dim> y = polar.conjugate(torque);
  for (int a = 0; a < nc; ++a)
    force.col(a) = polar.force(y, shape.gradient.col(a)) - r * f.col(a);
  return 0.5 * f.cwiseProduct(turned).sum();
}
} // namespace ligament::fem
