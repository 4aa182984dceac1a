// A mesh whose two sides across an axis are one: nodes of the upper one follow those of the lower.
#pragma once

#include "fem/mesh.h"

namespace ligament::fem
{
/// Joins the sides 2 * axis and 2 * axis + 1 of the box from `lower` to `upper` (m): their faces
/// are no longer part of the boundary, nodes of the upper side hang, with their twin on the lower
/// one as master. Axes may be joined one after the other. Throws core::InputError with the place
/// where a node has no twin.
template <int dim>
void join_sides(Mesh<dim> &mesh, int axis, const Vector<dim> &lower, const Vector<dim> &upper);
} // namespace ligament::fem
