#include "fem/part_shares.h"

#include "fem/cell_map.h"

namespace ligament::fem
{
template <int dim>
Vec<n_cell_nodes<dim>> part_shares(const core::Part<dim> &part, const Vector<dim> &lower,
                                   const Vector<dim> &size, int face)
{
  Vec<n_cell_nodes<dim>> shares = Vec<n_cell_nodes<dim>>::Zero();
  const auto piece = part.clip(core::side_corners<dim>(lower, lower + size, face));
  if (piece.empty())
    return shares;
  // On the face they are linear (2D) or bilinear (3D): the midpoint of a segment and the midpoints
  // of a triangle's edges integrate them exactly.
  if constexpr (dim == 2)
    return core::face_area<2>(piece) * shape_values<2>(lower, size, core::face_centroid<2>(piece));
  for (std::size_t k = 2; k < piece.size(); ++k) {
    const core::FaceCorners<dim> triangle = {piece[0], piece[k - 1], piece[k]};
    const double third = core::face_area<dim>(triangle) / 3;
    for (std::size_t a = 0; a < 3; ++a)
      shares += third * shape_values<dim>(lower, size, (triangle[a] + triangle[(a + 1) % 3]) / 2);
  }
  return shares;
}

template <int dim>
Vec<n_cell_nodes<dim>> part_shares(const core::Part<dim> &part, const Mesh<dim> &mesh,
                                   const CellFace<dim> &face)
{
  if (mesh.is_box(face.cell))
    return part_shares<dim>(part, mesh.cell_lower[face.cell], mesh.cell_size[face.cell], face.face);
  const CellVectors<dim> corners = cell_corners(mesh, face.cell);
  const Vec<n_cell_nodes<dim>> whole = face_shares<dim>(corners, face.face);
  const auto outline = face_corners<dim>(corners, face.face);
  const auto piece = part.clip(outline);
  Vec<n_cell_nodes<dim>> shares = Vec<n_cell_nodes<dim>>::Zero();
  const double area = core::face_area<dim>(piece);
  if (piece.empty() || area == 0)
    return shares;
  if (area >= (1 - 1e-12) * core::face_area<dim>(outline))
    return whole;
  if constexpr (dim == 2) { // along the segment they are linear
    const auto nodes = face_nodes<2>(face.face);
    const double along =
        (core::face_centroid<2>(piece) - outline[0]).norm() / (outline[1] - outline[0]).norm();
    shares[nodes[0]] = area * (1 - along);
    shares[nodes[1]] = area * along;
    return shares;
  }
  for (std::size_t k = 2; k < piece.size(); ++k) {
    const core::FaceCorners<dim> triangle = {piece[0], piece[k - 1], piece[k]};
    const double third = core::face_area<dim>(triangle) / 3;
    for (std::size_t a = 0; a < 3; ++a)
      shares += third * shape_values(mesh, face.cell,
                                     Vector<dim>((triangle[a] + triangle[(a + 1) % 3]) / 2));
  }
  return shares;
}

template Vec<4> part_shares(const core::Part<2> &, const Vector<2> &, const Vector<2> &, int);
template Vec<8> part_shares(const core::Part<3> &, const Vector<3> &, const Vector<3> &, int);
template Vec<4> part_shares(const core::Part<2> &, const Mesh<2> &, const CellFace<2> &);
template Vec<8> part_shares(const core::Part<3> &, const Mesh<3> &, const CellFace<3> &);
} // namespace ligament::fem
