#include "fem/cell_map.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <cmath>
#include <limits>

namespace ligament::fem
{
namespace
{
/// Gauss' points of the unit cube of n dimensions, all of weight 2^-n.
template <int n>
std::array<Vec<n>, 1 << n> unit_gauss_points()
{
  const double half = 0.5 / std::sqrt(3.);
  std::array<Vec<n>, 1 << n> points;
  for (int q = 0; q < 1 << n; ++q)
    for (int k = 0; k < n; ++k)
      points[q][k] = 0.5 + (q >> k & 1 ? half : -half);
  return points;
}
} // namespace

template <int dim>
CellVectors<dim> cell_corners(const Mesh<dim> &mesh, int cell)
{
  CellVectors<dim> corners;
  for (int a = 0; a < n_cell_nodes<dim>; ++a)
    if (mesh.is_box(cell))
      corners.col(a) = mesh.cell_lower[cell] + corner<dim>(mesh.cell_size[cell], a);
    else
      corners.col(a) = mesh.nodes[mesh.cells[cell][a]];
  return corners;
}

template <int dim>
Vec<n_cell_nodes<dim>> shape_values_at(const Vector<dim> &s)
{
  return shape_values<dim>(Vector<dim>::Zero(), Vector<dim>::Ones(), s);
}

template <int dim>
CellVectors<dim> shape_slopes_at(const Vector<dim> &s)
{
  return shape_gradients<dim>(Vector<dim>::Zero(), Vector<dim>::Ones(), s);
}

template <int dim>
Vector<dim> cell_point(const CellVectors<dim> &corners, const Vector<dim> &s)
{
  return corners * shape_values_at<dim>(s);
}

template <int dim>
Eigen::Matrix<double, dim, dim> cell_jacobian(const CellVectors<dim> &corners, const Vector<dim> &s)
{
  return corners * shape_slopes_at<dim>(s).transpose();
}

template <int dim>
CellVectors<dim> shape_gradients_at(const CellVectors<dim> &corners, const Vector<dim> &s)
{
  const CellVectors<dim> slopes = shape_slopes_at<dim>(s);
  const Eigen::Matrix<double, dim, dim> jacobian = corners * slopes.transpose();
  return jacobian.inverse().transpose() * slopes;
}

template <int dim>
std::optional<Vector<dim>> unit_place(const CellVectors<dim> &corners, const Vector<dim> &p)
{
  const Vector<dim> origin = corners.col(0); // differences of places near each other
  const CellVectors<dim> offsets = corners.colwise() - origin;
  const Vector<dim> target = p - origin;
  const double extent = offsets.cwiseAbs().maxCoeff();
  Vector<dim> s = cell_centre<dim>();
  Vector<dim> gap = target - cell_point<dim>(offsets, s);
  for (int iteration = 0; iteration < 50; ++iteration) {
    const Eigen::Matrix<double, dim, dim> jacobian = cell_jacobian<dim>(offsets, s);
    if (!(jacobian.determinant() > 0))
      return {};
    const Vector<dim> step = jacobian.inverse() * gap;
    // Half of it where all of it leads away: points outside, behind the fold of the map.
    double factor = 1;
    Vector<dim> next = s + step, next_gap = target - cell_point<dim>(offsets, next);
    while (next_gap.norm() > gap.norm() && next_gap.norm() > 1e-14 * extent && factor > 1e-3) {
      factor /= 2;
      next = s + factor * step;
      next_gap = target - cell_point<dim>(offsets, next);
    }
    s = next;
    gap = next_gap;
    if (factor * step.cwiseAbs().maxCoeff() <= 1e-14 || gap.norm() <= 1e-15 * extent)
      return s;
  }
  if (gap.norm() <= 1e-12 * extent)
    return s;
  return {};
}

template <int dim>
Vec<n_cell_nodes<dim>> shape_values(const Mesh<dim> &mesh, int cell, const Vector<dim> &p)
{
  if (mesh.is_box(cell))
    return shape_values<dim>(mesh.cell_lower[cell], mesh.cell_size[cell], p);
  const auto s = unit_place<dim>(cell_corners(mesh, cell), p);
  return s ? shape_values_at<dim>(*s)
           : Vec<n_cell_nodes<dim>>::Constant(std::numeric_limits<double>::quiet_NaN());
}

template <int dim>
CellVectors<dim> shape_gradients(const Mesh<dim> &mesh, int cell, const Vector<dim> &p)
{
  if (mesh.is_box(cell))
    return shape_gradients<dim>(mesh.cell_lower[cell], mesh.cell_size[cell], p);
  const CellVectors<dim> corners = cell_corners(mesh, cell);
  const auto s = unit_place<dim>(corners, p);
  return s ? shape_gradients_at<dim>(corners, *s)
           : CellVectors<dim>::Constant(std::numeric_limits<double>::quiet_NaN());
}

template <int dim>
CellVectors<dim> centre_gradients(const Mesh<dim> &mesh, int cell)
{
  if (!mesh.is_box(cell))
    return shape_gradients_at<dim>(cell_corners(mesh, cell), cell_centre<dim>());
  const Vector<dim> &lower = mesh.cell_lower[cell], &size = mesh.cell_size[cell];
  return shape_gradients<dim>(lower, size, lower + size / 2);
}

template <int dim>
Vec<n_cell_nodes<dim>> volume_shares(const CellVectors<dim> &corners)
{
  Vec<n_cell_nodes<dim>> shares = Vec<n_cell_nodes<dim>>::Zero();
  for (const Vector<dim> &s : unit_gauss_points<dim>()) {
    shares +=
        cell_jacobian<dim>(corners, s).determinant() / n_cell_nodes<dim> * shape_values_at<dim>(s);
  }
  return shares;
}

template <int dim>
Vec<n_cell_nodes<dim>> volume_shares(const Mesh<dim> &mesh, int cell)
{
  if (mesh.is_box(cell))
    return Vec<n_cell_nodes<dim>>::Constant(mesh.cell_size[cell].prod() / n_cell_nodes<dim>);
  return volume_shares<dim>(cell_corners(mesh, cell));
}

template <int dim>
double cell_volume(const Mesh<dim> &mesh, int cell)
{
  return mesh.is_box(cell) ? mesh.cell_size[cell].prod() : volume_shares(mesh, cell).sum();
}

// theory.md eq. (F11). Modes u = e_c (1 - xi_k^2), their gradients through the Jacobian at the
// centre and j0/j: their mean over the cell vanishes.
template <int dim>
CellMatrix<dim> cell_stiffness(const CellVectors<dim> &corners, const Stiffness<dim> &c,
                               double thickness)
{
  using Matrix = Eigen::Matrix<double, dim, dim>;
  constexpr int n = dim * n_cell_nodes<dim>, modes = n_cell_modes<dim>;
  const Matrix centre = cell_jacobian<dim>(corners, cell_centre<dim>());
  const double j0 = centre.determinant();
  CellVectors<dim> across = CellVectors<dim>::Zero(); // normals of xi_k at the centre
  across.template leftCols<dim>() = centre.inverse().transpose();
  across.template leftCols<dim>().colwise().normalize();
  const auto strains = strain_matrix<dim>(across);

  Eigen::Matrix<double, n + modes, n + modes> k; // of corners and modes
  k.setZero();
  for (const Vector<dim> &s : unit_gauss_points<dim>()) {
    const double j = cell_jacobian<dim>(corners, s).determinant();
    const Vector<dim> xi = 2 * s - Vector<dim>::Ones();
    Eigen::Matrix<double, n_strains<dim>, modes> g =
        Eigen::Matrix<double, n_strains<dim>, modes>::Zero();
    for (int d = 0; d < dim; ++d)
      g.template middleCols<dim>(dim * d) = xi[d] * strains.template middleCols<dim>(dim * d);
    if constexpr (dim == 3)
      for (int d = 0; d < 3; ++d)
        g.col(9 + d).template head<3>().setConstant(xi[(d + 1) % 3] * xi[(d + 2) % 3]);
    Eigen::Matrix<double, n_strains<dim>, n + modes> b;
    b << strain_matrix<dim>(shape_gradients_at<dim>(corners, s)), j0 / j * g;
    k += j * thickness / n_cell_nodes<dim> * b.transpose() * c * b;
  }
  const Eigen::Matrix<double, modes, n> coupled = k.template bottomLeftCorner<modes, n>();
  const Eigen::Matrix<double, modes, modes> own = k.template bottomRightCorner<modes, modes>();
  const CellMatrix<dim> condensed =
      k.template topLeftCorner<n, n>() - coupled.transpose() * own.ldlt().solve(coupled);
  return (condensed + condensed.transpose()) / 2;
}

template <int dim>
CellMatrix<dim> cell_stiffness(const CellVectors<dim> &corners, const Body<dim> &body)
{
  CellMatrix<dim> k = cell_stiffness<dim>(corners, body.stiffness, body.thickness);
  if (body.stress.isZero(0))
    return k;
  for (const Vector<dim> &s : unit_gauss_points<dim>())
    k += stress_stiffness<dim>(shape_gradients_at<dim>(corners, s), body.stress,
                               cell_jacobian<dim>(corners, s).determinant() * body.thickness /
                                   n_cell_nodes<dim>);
  return k;
}

template <int dim>
CellMatrix<dim> cell_stiffness(const Mesh<dim> &mesh, int cell, const Body<dim> &body)
{
  return mesh.is_box(cell) ? cell_stiffness<dim>(mesh.cell_size[cell], body)
                           : cell_stiffness<dim>(cell_corners(mesh, cell), body);
}

template <int dim>
core::FaceCorners<dim> face_corners(const CellVectors<dim> &corners, int face)
{
  const auto nodes = face_nodes<dim>(face);
  core::FaceCorners<dim> turn = {corners.col(nodes[0]), corners.col(nodes[1])};
  if constexpr (dim == 3) {
    turn.push_back(corners.col(nodes[3]));
    turn.push_back(corners.col(nodes[2]));
  }
  return turn;
}

template <int dim>
Vec<n_cell_nodes<dim>> face_shares(const CellVectors<dim> &corners, int face)
{
  Vec<n_cell_nodes<dim>> shares = Vec<n_cell_nodes<dim>>::Zero();
  const auto nodes = face_nodes<dim>(face);
  if constexpr (dim == 2) {
    const double half = (corners.col(nodes[1]) - corners.col(nodes[0])).norm() / 2;
    shares[nodes[0]] = shares[nodes[1]] = half;
  } else {
    CellVectors<2> plane = CellVectors<2>::Zero();
    for (const Vector<2> &s : unit_gauss_points<2>()) {
      const Vec<4> value = shape_values_at<2>(s);
      plane = shape_slopes_at<2>(s);
      Vector<3> along = Vector<3>::Zero(), up = Vector<3>::Zero();
      for (int a = 0; a < 4; ++a) {
        along += plane(0, a) * corners.col(nodes[a]);
        up += plane(1, a) * corners.col(nodes[a]);
      }
      const double area = along.cross(up).norm() / 4;
      for (int a = 0; a < 4; ++a)
        shares[nodes[a]] += area * value[a];
    }
  }
  return shares;
}

template <int dim>
Vector<dim> face_normal(const CellVectors<dim> &corners, int face)
{
  const auto turn = face_corners<dim>(corners, face);
  Vector<dim> normal;
  if constexpr (dim == 2) {
    const Vector<2> along = turn[1] - turn[0];
    normal = Vector<2>(along[1], -along[0]).normalized();
  } else
    normal = (turn[2] - turn[0]).cross(turn[3] - turn[1]).normalized();
  const Vector<dim> outwards = core::face_centroid<dim>(turn) - corners.rowwise().mean();
  return normal.dot(outwards) < 0 ? Vector<dim>(-normal) : normal;
}

#define LIGAMENT_INSTANTIATE(dim)                                                                  \
  template CellVectors<dim> cell_corners(const Mesh<dim> &, int);                                  \
  template Vec<n_cell_nodes<dim>> shape_values_at<dim>(const Vector<dim> &);                       \
  template CellVectors<dim> shape_slopes_at<dim>(const Vector<dim> &);                             \
  template Vector<dim> cell_point<dim>(const CellVectors<dim> &, const Vector<dim> &);             \
  template Eigen::Matrix<double, dim, dim> cell_jacobian<dim>(const CellVectors<dim> &,            \
                                                              const Vector<dim> &);                \
  template CellVectors<dim> shape_gradients_at<dim>(const CellVectors<dim> &,                      \
                                                    const Vector<dim> &);                          \
  template std::optional<Vector<dim>> unit_place<dim>(const CellVectors<dim> &,                    \
                                                      const Vector<dim> &);                        \
  template Vec<n_cell_nodes<dim>> shape_values(const Mesh<dim> &, int, const Vector<dim> &);       \
  template CellVectors<dim> shape_gradients(const Mesh<dim> &, int, const Vector<dim> &);          \
  template CellVectors<dim> centre_gradients(const Mesh<dim> &, int);                              \
  template Vec<n_cell_nodes<dim>> volume_shares<dim>(const CellVectors<dim> &);                    \
  template Vec<n_cell_nodes<dim>> volume_shares(const Mesh<dim> &, int);                           \
  template double cell_volume(const Mesh<dim> &, int);                                             \
  template CellMatrix<dim> cell_stiffness<dim>(const CellVectors<dim> &, const Stiffness<dim> &,   \
                                               double);                                            \
  template CellMatrix<dim> cell_stiffness<dim>(const CellVectors<dim> &, const Body<dim> &);       \
  template CellMatrix<dim> cell_stiffness(const Mesh<dim> &, int, const Body<dim> &);              \
  template core::FaceCorners<dim> face_corners<dim>(const CellVectors<dim> &, int);                \
  template Vec<n_cell_nodes<dim>> face_shares<dim>(const CellVectors<dim> &, int);                 \
  template Vector<dim> face_normal<dim>(const CellVectors<dim> &, int);
LIGAMENT_INSTANTIATE(2)
LIGAMENT_INSTANTIATE(3)
#undef LIGAMENT_INSTANTIATE
} // namespace ligament::fem
