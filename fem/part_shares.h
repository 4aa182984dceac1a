// What a load on a part of a side gives to the nodes of a cell there.
#pragma once

#include "core/part.h"
#include "fem/mesh.h"

namespace ligament::fem
{
/// Integrals of the shape functions over what of the cell's face (2 * axis + (0 lower, 1 upper))
/// lies in the part, in m^(dim-1); exact.
template <int dim>
Vec<n_cell_nodes<dim>> part_shares(const core::Part<dim> &part, const Vector<dim> &lower,
                                   const Vector<dim> &size, int face);

/// The same of a face of a mesh. On faces of general cells: exact in 2D and where the part holds
/// the whole face; a face in 3D that is cut has its area exactly, and two-point accuracy in its
/// shares.
template <int dim>
Vec<n_cell_nodes<dim>> part_shares(const core::Part<dim> &part, const Mesh<dim> &mesh,
                                   const CellFace<dim> &face);
} // namespace ligament::fem
