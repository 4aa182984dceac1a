// The geometry of a packing as tables: what was found once at some cost is not sought again.
#pragma once

#include "core/state.h"
#include "packings/random_packing.h"

namespace ligament::packings
{
/// Cells, faces, outer faces and seeds as the tables "cells", "cell_faces", "outer_faces" and
/// "seeds", bit by bit.
template <int dim>
void save_packing(core::State &state, const RandomPacking<dim> &packing);

/// The same packing again, without relaxation or clipping; the initial cracks are the specimen's.
/// Throws core::InputError where a table lacks something.
template <int dim>
RandomPacking<dim> load_packing(const core::State &state, const SpecimenParameters<dim> &specimen);
} // namespace ligament::packings
