// Which cells of a mesh are boxes, and how far the others are from one.
#pragma once

#include "fem/mesh.h"

#include <string>

namespace ligament::fem
{
/// Fills cell_lower, cell_size and general from nodes and cells: whoever makes or moves nodes calls
/// it. Cells within 1e-12 of their bounding box are boxes.
template <int dim>
void find_cell_shapes(Mesh<dim> &mesh);

/// Least scaled Jacobian over the corners: the determinant of the unit vectors along the edges that
/// meet there, 1 for a box, 0 or less where the cell is not convex.
template <int dim>
double scaled_jacobian(const CellVectors<dim> &corners);

/// Largest angle between two edges of a face, in degrees; 180 and more where a face of a cell in 2D
/// turns inwards.
template <int dim>
double worst_angle(const CellVectors<dim> &corners);

/// Where the middle of a cell lies, as messages tell it: "(x, y) m".
template <int dim>
std::string place_text(const Mesh<dim> &mesh, int cell);

/// Throws core::InputError with the place of the first cell that general cells cannot be: in 2D an
/// angle of 170 degrees or more, in 3D a corner or Gauss point whose Jacobian is not positive.
template <int dim>
void require_convex(const Mesh<dim> &mesh);
} // namespace ligament::fem
