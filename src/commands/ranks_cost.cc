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

// Of a particle: the copy near the peak, place, motion, stress, names and what follows from them,
// which each rank keeps of its own; and the same of the whole body where the first rank gathers and
// packs it to write it.
constexpr double kept_bytes = 24 * sizeof(double), written_bytes = 300;

// Of a process before it has particles: of `check`, of a rank, and what pictures take besides.
constexpr double empty_check = 155e6, empty_rank = 175e6, drawing = 38e6; // bytes

// Of a particle at the peak of the set-up (docs/scaling.md): what is left of a coupled body is
// mesh.
template <int dim>
constexpr double particle_bytes = dim == 2 ? 516 : 1034;

// Of what an equilibrium takes on one process: the matrix that the first rank hands out, and the
// rows and levels that ranks share.
constexpr double matrix_share = 0.2, level_share = 0.7;

/// Of the cells of the overlap, which are stepped together.
template <int dim>
std::vector<std::vector<int>> groups_of(const CoupledBody<dim> &body)
{
  const auto *overlap = body.coupler->overlap();
  std::vector<std::vector<int>> groups(overlap ? overlap->cells.size() : 0);
  if (overlap)
    for (const auto &member : overlap->members)
      groups[member.cell].push_back(member.particle);
  return groups;
}

/// Particles that each rank sees and doesn't own, rings of faces around what it steps.
template <int dim>
std::vector<std::int64_t> ghosts_of(const CoupledBody<dim> &body,
                                    const particles::Partition &partition, int rings)
{
  const int n = body.zone->state.size();
  const auto groups = groups_of(body);
  std::vector<std::int64_t> ghosts;
  for (int rank = 0; rank < partition.n_ranks(); ++rank) {
    std::vector<char> seen(n, 0);
    std::vector<int> rim, ring;
    for (std::int64_t i = partition.begin(rank); i < partition.end(rank); ++i) {
      seen[i] = 1;
      rim.push_back(int(i));
    }
    ghosts.push_back(0);
    for (const std::vector<int> &group : groups)
      if (std::any_of(group.begin(), group.end(),
                      [&](int i) { return i >= partition.begin(rank) && i < partition.end(rank); }))
        for (const int i : group)
          if (!seen[i]) {
            seen[i] = 1;
            rim.push_back(i);
            ++ghosts.back();
          }
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
                     const StepCost &cost, double memory, double equilibrium_memory)
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
  const auto *overlap = body.coupler->overlap();
  // What nodes sum, told to all: forces and what the carrier takes.
  const double nodal = overlap ? 2. * overlap->n_nodes() * dim * sizeof(double) : 0;
  const double bytes = double(c.ghosts) * (dim == 2 ? 3 : 7) * sizeof(double) + nodal,
               agreed = (body.force()->can_break() + (overlap ? 1 : 0)) * 2 *
                        std::ceil(std::log2(ranks));
  c.mesh_seconds = body.far ? cost.mesh_share * cost.seconds_per_step : 0;
  c.seconds_per_step = (cost.seconds_per_step - c.mesh_seconds) *
                           (double(c.largest_part) + ghost_share * double(c.ghosts)) / n +
                       c.mesh_seconds + (n_sides + agreed) * latency + bytes / bandwidth;
  const double whole = std::max(memory - empty_check, 0.),
               of_particles = body.far ? std::min(whole, n * particle_bytes<dim>) : whole;
  // The overlap's particles are there once more on each rank, whole.
  const double members = overlap ? double(overlap->members.size()) : 0,
               share = (double(c.largest_part) + double(c.ghosts) + members) / n;
  c.other_memory = empty_rank + whole - of_particles + share * of_particles +
                   double(c.largest_part) * kept_bytes;
  c.whole_at_first = scene.time.has_phases();
  c.memory = c.other_memory + drawing + n * written_bytes +
             (c.whole_at_first ? whole + equilibrium_memory : 0);
  if (scene.time.static_solver == StaticSolver::parallel_multigrid) {
    const double of_levels = level_share * equilibrium_memory / ranks;
    c.memory += of_levels - (1 - matrix_share) * equilibrium_memory;
    c.other_memory += of_levels;
  }
  return c;
}

std::string to_text(const RanksCost &cost, double seconds_per_step)
{
  std::string text = fmt::format(
      "  on {} ranks           up to {} particles and {} ghosts each; {:.3g} ms a step, {:.2f}x; "
      "{:.0f} MiB on the first one, {:.0f} MiB on others\n",
      cost.ranks, cost.largest_part, cost.ghosts, 1e3 * cost.seconds_per_step,
      seconds_per_step / cost.seconds_per_step, cost.memory / 1048576, cost.other_memory / 1048576);
  if (cost.mesh_seconds > 0)
    text +=
        fmt::format("                       {:.3g} ms of it for the mesh and its overlap, which "
                    "every rank has whole\n",
                    1e3 * cost.mesh_seconds);
  if (cost.whole_at_first)
    text += "                       the first one has the whole body besides where it seeks "
            "equilibria\n";
  const unsigned cores = std::thread::hardware_concurrency();
  if (cost.ranks > int(cores))
    text += fmt::format("  this machine has {} cores: more ranks wait for each other\n", cores);
  return text;
}

template RanksCost ranks_cost(const Scene &, const CoupledBody<2> &, int, const StepCost &, double,
                              double);
template RanksCost ranks_cost(const Scene &, const CoupledBody<3> &, int, const StepCost &, double,
                              double);
} // namespace ligament::program
