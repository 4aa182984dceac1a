// What a step of a body of particles costs on several ranks: predicted from one process.
#pragma once

#include "src/commands/step_cost.h"

namespace ligament::program
{
struct RanksCost
{
  int ranks = 1;
  std::int64_t largest_part = 0; // particles that a rank owns, at most
  std::int64_t ghosts = 0;       // that it sees besides, at most
  double seconds_per_step = 0;   // on as many idle cores
  double memory = 0;             // bytes, of the first rank, which gathers what is written
  double other_memory = 0;       // bytes, of each of the others
};

/// `cost` and `memory` (bytes) are those of one process. Ranks wait for the largest part; a ghost
/// costs half of a particle, of its pressures alone; messages of a step pass between neighbours
/// and, where bonds break, all. The body is whole.
template <int dim>
RanksCost ranks_cost(const Scene &scene, const CoupledBody<dim> &body, int ranks,
                     const StepCost &cost, double memory);

/// For the card of `check`.
std::string to_text(const RanksCost &cost, double seconds_per_step);
} // namespace ligament::program
