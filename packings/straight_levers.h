// Cells of a lattice that a side cuts, as particles that flow need them.
#pragma once

#include "packings/packing.h"

namespace ligament::packings
{
/// The levers of faces lie along their normals then, as those of whole cells do: no strains of the
/// particles' own lower the energy without bound (docs/theory.md, section 1.10, eq. (D22c)). Of all
/// faces between particles at whose centres `flows`.
template <int dim, typename Flows>
void straighten_levers(Packing<dim> &packing, const Flows &flows)
{
  for (auto &face : packing.faces) {
    if (!flows(get(packing.centre, face.i)) || !flows(get(packing.centre, face.j)))
      continue;
    face.lever_i = face.q_i * face.normal;
    face.lever_j = -face.q_j * face.normal;
  }
}
} // namespace ligament::packings
