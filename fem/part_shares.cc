#include "fem/part_shares.h"

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

template Vec<4> part_shares(const core::Part<2> &, const Vector<2> &, const Vector<2> &, int);
template Vec<8> part_shares(const core::Part<3> &, const Vector<3> &, const Vector<3> &, int);
} // namespace ligament::fem
