// The far-field mesh from quadrilaterals that somebody else made.
#pragma once

#include "fem/mesh.h"

namespace ligament::fem
{
/// `quads`: corners in turn, either way round, into the places `given` (m). Cells inside the inner
/// boxes are left out. Sides of the mesh get the boundary of the outline's nearest side. Nodes and
/// cells are numbered as in the input, those left out skipped; rectangles along x and y become
/// boxes, coordinates that differ by 1e-9 of a cell at most being taken as equal.
///
/// Throws core::InputError with the place of a cell that an inner box cuts, of one that is not
/// convex, and where the surface of the cells is not the outline.
Mesh<2> import_mesh(const std::vector<Vector<2>> &given,
                    const std::vector<std::array<int, 4>> &quads, const core::Solid<2> &outline,
                    const std::vector<InnerBox<2>> &inner);
} // namespace ligament::fem
