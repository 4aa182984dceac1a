#include "fem/pressed_faces.h"

#include "fem/cell_map.h"
#include "fem/part_shares.h"

#include <Eigen/Geometry>

namespace ligament::fem
{
template <int dim>
PressedFace<dim>::PressedFace(const Mesh<dim> &mesh, const CellFace<dim> &face,
                              const core::Part<dim> &part, double thickness, int load)
    : load_(load), factor_(1)
{
  std::array<Vector<dim>, n_corners> corners;
  Vector<dim> outward = -cell_point<dim>(cell_corners(mesh, face.cell), cell_centre<dim>());
  const auto shares = part_shares<dim>(part, mesh, face);
  int k = 0;
  for (const int a : face_nodes<dim>(face.face)) {
    nodes_[k] = mesh.cells[face.cell][a];
    corners[k] = mesh.nodes[nodes_[k]];
    shares_[k] = shares[a];
    outward += corners[k] / n_corners;
    ++k;
  }
  const Vector<dim> area = area_between(corners);
  factor_ = area.dot(outward) < 0 ? -thickness : thickness;
  for (double &share : shares_)
    share /= area.norm();
}

template <int dim>
Vector<dim> PressedFace<dim>::area_between(const std::array<Vector<dim>, n_corners> &corners) const
{
  if constexpr (dim == 2) {
    const Vector<2> along = corners[1] - corners[0];
    return factor_ * Vector<2>(along[1], -along[0]);
  } else
    return factor_ / 2 *
           Vector<3>(corners[3] - corners[0]).cross(Vector<3>(corners[2] - corners[1]));
}

template <int dim>
Vector<dim> PressedFace<dim>::area(const Mesh<dim> &mesh, const Components<dim> &displacement) const
{
  std::array<Vector<dim>, n_corners> corners;
  for (int k = 0; k < n_corners; ++k)
    for (int c = 0; c < dim; ++c)
      corners[k][c] = mesh.nodes[nodes_[k]][c] + displacement[c][nodes_[k]];
  return area_between(corners);
}

template class PressedFace<2>;
template class PressedFace<3>;
} // namespace ligament::fem
