// What a step of a body costs on several ranks: predicted from one process.
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
  double mesh_seconds = 0;       // of it, for far field and overlap
  double memory = 0;             // bytes, of the first rank, which gathers what is written
  double other_memory = 0;       // bytes, of each of the others
  bool whole_at_first = false;   // the first one has the whole body besides, for equilibria
};

/// `cost`, `memory` and that of an equilibrium (bytes) are those of one process. Ranks wait for the
/// largest part; a ghost costs half of a particle, of its pressures alone; messages of a step pass
/// between neighbours and, where bonds break or a mesh is there, all. What the mesh takes it takes
/// on every rank, time and memory: the passes over the members of the overlap, which ranks share,
/// count as its own. The body is whole.
template <int dim>
RanksCost ranks_cost(const Scene &scene, const CoupledBody<dim> &body, int ranks,
                     const StepCost &cost, double memory, double equilibrium_memory);

/// For the card of `check`.
std::string to_text(const RanksCost &cost, double seconds_per_step);
} // namespace ligament::program
