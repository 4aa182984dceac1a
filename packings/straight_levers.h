// Cells of a lattice that a side cuts, as particles that flow need them.
#pragma once

#include "packings/packing.h"

namespace ligament::packings
{
/// The levers of all faces lie along their normals then, as those of whole cells do: no strains of
/// the particles' own lower the energy without bound (docs/theory.md, section 1.10, eq. (D22c)).
template <int dim>
void straighten_levers(Packing<dim> &packing)
{
  for (auto &face : packing.faces) {
    face.lever_i = face.q_i * face.normal;
    face.lever_j = -face.q_j * face.normal;
  }
}
} // namespace ligament::packings
