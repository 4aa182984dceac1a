// Random packings that ranks make by part.
#pragma once

#include "packings/packing_part.h"
#include "packings/random_packing.h"

namespace ligament::packings
{
template <int dim>
struct RandomPart
{
  PackingPart<dim> held;
  Seeds<dim> seeds; // of the whole, see RandomPacking
  int n_healed = 0; // likewise
};

/// What part_of() keeps of pack_relaxed_seeds() for one of several ranks, which all call it: each
/// has all seeds, and cuts only the cells that its part needs. Shares go by the weights of blocks
/// (particles::make_partition). Of a zone without joined sides.
template <int dim>
RandomPart<dim> make_random_part(const SpecimenParameters<dim> &specimen, Seeds<dim> seeds,
                                 const core::Ranks &ranks, int rings,
                                 const Groups<dim> &groups = {},
                                 const std::vector<std::int64_t> &weights = {});
} // namespace ligament::packings
