// Cracks in the far field: lines of cell edges along which the cells come apart.
#pragma once

#include "fem/mesh.h"

namespace ligament::fem
{
/// Opens the edges of cells on a polyline (m): the cells on its two sides get nodes of their own,
/// at the same places, and the edges become free faces. A tip inside the mesh keeps its one node;
/// a line that runs on through a side, into a hole or into a crack opened before parts the mesh
/// there. Flanks do not feel each other: they can overlap. Throws core::InputError with the place
/// where the line leaves the edges, or runs along a step between cell sizes; the mesh is as it was
/// then.
void open_crack(Mesh<2> &mesh, const std::vector<Vector<2>> &polyline);
} // namespace ligament::fem
