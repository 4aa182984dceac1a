// Makes a mesh of boxes follow an outline: cells that it cuts are left out, and a layer of general
// quadrilaterals goes from what is left to the outline.
#pragma once

#include "fem/mesh.h"
#include "fem/slanted_sides.h"

namespace ligament::fem
{
/// `mesh` covers the outline, inner boxes left out. Sides of the outline on `lines` of the mesh (by
/// axis, m) are borders of cells; all others get a layer of general cells, whose inner nodes move
/// where that makes angles better. Corners of the outline are nodes. Cells nearer to such a side
/// than 0.4 of their size are left out; outside them nothing moves but the two layers next to them.
///
/// Boundary faces carry the numbers of the outline's sides. Throws core::InputError with the place
/// where the cells are too large for the outline, and where a side that is no line of the mesh
/// meets what was left out.
Mesh<2> fit_outline(const Mesh<2> &mesh, const core::Solid<2> &outline,
                    const std::array<std::vector<double>, 2> &lines);
} // namespace ligament::fem
