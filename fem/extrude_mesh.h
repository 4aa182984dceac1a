// A prism's mesh from that of its plane.
#pragma once

#include "fem/mesh.h"
#include "fem/sectioned_axis.h"

namespace ligament::fem
{
/// The plane mesh in layers along z, less the cells whose middle lies in an inner box. Its sides
/// keep their boundaries, free ones are free, the ends are back and front. Cells that hang in the
/// plane hang in each layer.
Mesh<3> extrude_mesh(const Mesh<2> &plane, const SectionedAxis &axis,
                     const std::vector<InnerBox<3>> &inner);
} // namespace ligament::fem
