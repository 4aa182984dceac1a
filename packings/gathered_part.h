// The particles of an overlap, on every rank, from the parts that ranks hold.
#pragma once

#include "core/ranks.h"
#include "packings/packing_part.h"

namespace ligament::packings
{
/// What grouped_part() keeps of the whole, the same on all ranks, which all call it with what they
/// hold: at least so many rings around what is owned. Of packings without rows.
template <int dim>
Packing<dim> gather_grouped(const PackingPart<dim> &held, const Groups<dim> &groups, int rings,
                            const core::Ranks &ranks);
} // namespace ligament::packings
