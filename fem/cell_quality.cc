#include "fem/cell_quality.h"

#include "core/check.h"
#include "fem/cell_map.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ligament::fem
{
namespace
{
constexpr double largest_angle = 170; // degrees, in 2D

template <int dim>
Vector<dim> unit_corner(int a)
{
  return corner<dim>(Vector<dim>::Ones(), a);
}

template <int dim>
bool is_bounding_box(const CellVectors<dim> &corners, const Vector<dim> &lower,
                     const Vector<dim> &size)
{
  for (int a = 0; a < n_cell_nodes<dim>; ++a) {
    const Vector<dim> x = corners.col(a), box = lower + corner<dim>(size, a);
    const auto round_off = 4 * std::numeric_limits<double>::epsilon() * x.array().abs();
    if (((x - box).array().abs() > 1e-12 * size.array() + round_off).any())
      return false;
  }
  return true;
}

/// Smallest determinant of the Jacobian, in m^dim: at the corners, which a cell's volume needs, and
/// at Gauss' points, where its stiffness is summed.
template <int dim>
double least_jacobian(const CellVectors<dim> &corners)
{
  double least = std::numeric_limits<double>::infinity();
  for (int a = 0; a < n_cell_nodes<dim>; ++a) {
    const Vector<dim> gauss =
        cell_centre<dim>() + (unit_corner<dim>(a) - cell_centre<dim>()) / std::sqrt(3.);
    for (const Vector<dim> &s : {unit_corner<dim>(a), gauss})
      if (const double j = cell_jacobian<dim>(corners, s).determinant(); !(j >= least))
        least = j; // not a number, too
  }
  return least;
}
} // namespace

template <int dim>
void find_cell_shapes(Mesh<dim> &mesh)
{
  const int n = mesh.n_cells();
  mesh.cell_lower.resize(n);
  mesh.cell_size.resize(n);
  mesh.general.assign(n, 0);
  bool any = false;
  for (int cell = 0; cell < n; ++cell) {
    CellVectors<dim> corners;
    for (int a = 0; a < n_cell_nodes<dim>; ++a)
      corners.col(a) = mesh.nodes[mesh.cells[cell][a]];
    mesh.cell_lower[cell] = corners.rowwise().minCoeff();
    mesh.cell_size[cell] = corners.rowwise().maxCoeff() - mesh.cell_lower[cell];
    mesh.general[cell] =
        !is_bounding_box<dim>(corners, mesh.cell_lower[cell], mesh.cell_size[cell]);
    any = any || mesh.general[cell];
  }
  if (!any)
    mesh.general.clear();
}

template <int dim>
double scaled_jacobian(const CellVectors<dim> &corners)
{
  double least = 1;
  for (int a = 0; a < n_cell_nodes<dim>; ++a) {
    Eigen::Matrix<double, dim, dim> edges = cell_jacobian<dim>(corners, unit_corner<dim>(a));
    edges.colwise().normalize();
    const double j = edges.determinant();
    if (!(j >= least))
      least = j;
  }
  return least;
}

template <int dim>
double worst_angle(const CellVectors<dim> &corners)
{
  double worst = 0;
  for (int a = 0; a < n_cell_nodes<dim>; ++a) {
    const auto edges = cell_jacobian<dim>(corners, unit_corner<dim>(a));
    for (int i = 0; i < dim; ++i)
      for (int j = i + 1; j < dim; ++j) {
        double angle;
        if constexpr (dim == 2) {
          // Both axes from the lower to the upper end; at corners 1 and 2 one of them points in.
          const double sign = a == 1 || a == 2 ? -1 : 1;
          angle = std::atan2(edges.determinant(), sign * edges.col(0).dot(edges.col(1)));
          if (angle < 0)
            angle += 2 * M_PI;
        } else {
          const double sign = (a >> i & 1) == (a >> j & 1) ? 1 : -1;
          angle = std::atan2(edges.col(i).cross(edges.col(j)).norm(),
                             sign * edges.col(i).dot(edges.col(j)));
        }
        angle *= 180 / M_PI;
        if (!(angle <= worst))
          worst = angle;
      }
  }
  return worst;
}

template <int dim>
std::string place_text(const Mesh<dim> &mesh, int cell)
{
  const Vector<dim> centre = cell_corners(mesh, cell).rowwise().mean();
  std::string text = fmt::format("({:.4g}, {:.4g}", centre[0], centre[1]);
  if constexpr (dim == 3)
    text += fmt::format(", {:.4g}", centre[2]);
  return text + ") m";
}

template <int dim>
void require_convex(const Mesh<dim> &mesh)
{
  for (int cell = 0; cell < mesh.n_cells(); ++cell) {
    if (mesh.is_box(cell))
      continue;
    const CellVectors<dim> corners = cell_corners(mesh, cell);
    const double angle = dim == 2 ? worst_angle<dim>(corners) : 0;
    const bool is_flat = !(angle < largest_angle), is_folded = !(least_jacobian<dim>(corners) > 0);
    if (is_flat || is_folded)
      throw core::InputError(fmt::format(
          "the cell of the far field at {} is not convex enough: {}; move the points of the "
          "outline there or take smaller cells",
          place_text(mesh, cell),
          is_flat ? fmt::format("it has an angle of {:.1f} degrees, at {} it loses its stiffness",
                                angle, largest_angle)
                  : "it folds over at a corner"));
  }
}

template void find_cell_shapes(Mesh<2> &);
template void find_cell_shapes(Mesh<3> &);
template double scaled_jacobian<2>(const CellVectors<2> &);
template double scaled_jacobian<3>(const CellVectors<3> &);
template double worst_angle<2>(const CellVectors<2> &);
template double worst_angle<3>(const CellVectors<3> &);
template std::string place_text(const Mesh<2> &, int);
template std::string place_text(const Mesh<3> &, int);
template void require_convex(const Mesh<2> &);
template void require_convex(const Mesh<3> &);
} // namespace ligament::fem
