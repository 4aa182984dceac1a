#include "src/commands/ranks_cost.h"

#include "particles/partition.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>

namespace ligament::program
{
namespace
{
constexpr double ghost_share = 0.5; // of the cost of a particle that is stepped

// Between processes of one machine.
constexpr double latency = 5e-6;  // s, of a message
constexpr double bandwidth = 3e9; // bytes/s

// Values per particle of the fields that the first rank gathers to write them: place, motion,
// stress, names, and what follows from them; as many again in the copy near the peak.
constexpr double gathered_bytes = 2 * 24 * sizeof(double);

// Of a process before it has particles.
constexpr double empty_process = 100e6; // bytes

/// Particles that each rank sees and doesn't own, rings of faces around its own.
template <int dim>
std::vector<std::int64_t> ghosts_of(const CoupledBody<dim> &body,
                                    const particles::Partition &partition, int rings)
{
  const int n = body.zone->state.size();
  std::vector<std::int64_t> ghosts;
  for (int rank = 0; rank < partition.n_ranks(); ++rank) {
    std::vector<char> seen(n, 0);
    std::vector<int> rim, ring;
    for (std::int64_t i = partition.begin(rank); i < partition.end(rank); ++i) {
      seen[i] = 1;
      rim.push_back(int(i));
    }
    ghosts.push_back(0);
    for (int r = 0; r < rings; ++r, rim = ring) {
      ring.clear();
      body.force()->for_each_neighbour(
          body.zone->state,
          [&](const particles::Neighbour &neighbour) {
            if (!seen[neighbour.j]) {
              seen[neighbour.j] = 1;
              ring.push_back(neighbour.j);
            }
          },
          &rim);
      std::sort(ring.begin(), ring.end());
      ghosts.back() += std::int64_t(ring.size());
    }
  }
  return ghosts;
}
} // namespace

template <int dim>
RanksCost ranks_cost(const Scene &scene, const CoupledBody<dim> &body, int ranks,
                     const StepCost &cost, double memory)
{
  const double n = double(body.n_particles);
  const auto partition = particles::make_partition(body.n_particles, ranks);
  const int rings = ghost_rings<dim>(scene);
  const auto ghosts = ghosts_of(body, partition, rings);
  RanksCost c;
  c.ranks = ranks;
  for (int rank = 0; rank < ranks; ++rank) {
    c.largest_part = std::max(c.largest_part, partition.end(rank) - partition.begin(rank));
    c.ghosts = std::max(c.ghosts, ghosts[rank]);
  }
  const int n_sides = std::min(ranks - 1, 2);
  const double bytes = double(c.ghosts) * (dim == 2 ? 3 : 7) * sizeof(double),
               agreed = body.force()->can_break() ? 2 * std::ceil(std::log2(ranks)) : 0;
  c.seconds_per_step =
      cost.seconds_per_step * (double(c.largest_part) + ghost_share * double(c.ghosts)) / n +
      (n_sides + agreed) * latency + bytes / bandwidth;
  const double share = (double(c.largest_part) + double(c.ghosts)) / n;
  c.other_memory = empty_process + share * std::max(memory - empty_process, 0.);
  c.memory = c.other_memory + n * gathered_bytes;
  return c;
}

std::string to_text(const RanksCost &cost, double seconds_per_step)
{
  std::string text = fmt::format(
      "  on {} ranks           up to {} particles and {} ghosts each; {:.3g} ms a step, {:.2f}x; "
      "{:.0f} MiB on the first one, {:.0f} MiB on others\n",
      cost.ranks, cost.largest_part, cost.ghosts, 1e3 * cost.seconds_per_step,
      seconds_per_step / cost.seconds_per_step, cost.memory / 1048576, cost.other_memory / 1048576);
  const unsigned cores = std::thread::hardware_concurrency();
  if (cost.ranks > int(cores))
    text += fmt::format("  this machine has {} cores: more ranks wait for each other\n", cores);
  return text;
}

template RanksCost ranks_cost(const Scene &, const CoupledBody<2> &, int, const StepCost &, double);
template RanksCost ranks_cost(const Scene &, const CoupledBody<3> &, int, const StepCost &, double);
} // namespace ligament::program
