// Seeds of a packing as a table: what was found once at some cost is not sought again.
#pragma once

#include "core/state.h"
#include "packings/seeds.h"

namespace ligament::packings
{
/// Bit by bit.
template <int dim>
core::Table table_of(const Seeds<dim> &seeds);

/// Throws core::InputError where a column is missing.
template <int dim>
Seeds<dim> seeds_of(const core::Table &table);
} // namespace ligament::packings
