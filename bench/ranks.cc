// A body of particles in parts: mpirun -n RANKS bin/bench_ranks DIMENSION PARTICLES STEPS [WORD]
//
// Hexagonal or face-centred cubic, or with the word "random" that, twice as long along its layers'
// normal as it is wide; seconds a step, what of them goes into the exchange of ghosts (waiting
// included), bytes and messages of one rank in a step, and how unequal the ranks' forces are. With
// the word "soften" both halves are drawn apart across all seams, layer from layer: faces between
// them soften.
#include "core/flush_denormals.h"
#include "core/mpi_job.h"
#include "dem/many_body_force.h"
#include "packings/lattice_packing.h"
#include "packings/random_part.h"
#include "particles/particle_solver.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <string>

#include <sys/resource.h>

namespace
{
using namespace ligament;

double now()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <int dim>
double width_of(double n_particles)
{
  return std::pow(n_particles / 2 * (dim == 2 ? std::sqrt(0.75) : std::sqrt(0.5)), 1. / dim);
}

template <int dim, typename Parameters>
Parameters specimen_of(double n_particles)
{
  Parameters p;
  p.spacing = 1;
  p.upper.setConstant(width_of<dim>(n_particles));
  p.upper[dim - 1] *= 2;
  return p;
}

template <int dim>
packings::PackingPart<dim> pack_part(const core::Ranks &ranks, double n_particles, bool is_random,
                                     int rings)
{
  if (!is_random)
    return packings::make_lattice_part(
        specimen_of<dim, packings::LatticeParameters<dim>>(n_particles), ranks, rings);
  const auto p = specimen_of<dim, packings::RandomParameters<dim>>(n_particles);
  const double began = now();
  auto seeds = packings::make_random_seeds(p, ranks);
  if (ranks.is_first())
    fmt::print("seeds relaxed in {:.2f} s\n", now() - began);
  return packings::make_random_part<dim>(p, std::move(seeds), ranks, rings).held;
}

template <int dim>
void measure(const core::Ranks &ranks, double n_particles, int steps, const std::string &word)
{
  const bool is_random = word == "random", softens = word == "soften";
  const dem::DemMaterial material{1, 0.3, 1, PlaneMode::strain, 0};
  dem::FractureLaw law;
  law.criterion = dem::FractureLaw::Criterion::face_tension;
  law.strength = 1;
  if (softens) {
    law.criterion = dem::FractureLaw::Criterion::maximum_tension;
    law.strength = 1e-3;
    law.energy = 100 * 1e-6; // over so many spacings
  }

  double began = now();
  auto held = pack_part<dim>(ranks, n_particles, is_random, dem::ManyBodyForce<dim>::n_rings(law));
  const double packed = now() - began;
  const std::int64_t n = held.n_whole;
  auto force = std::make_unique<dem::ManyBodyForce<dim>>(
      held.packing, material, std::vector<core::BoundaryLoad<dim>>{}, law);
  std::vector<packings::Face<dim>>().swap(held.packing.faces); // before particles are made
  particles::Particles<dim> p;
  packings::fill_particles(held.packing, 1, p);
  p.part = held.part;
  particles::for_each(p.part.owned, [&](int i) {
    p.velocity[0][i] = 1e-4 * std::sin(0.1 * p.reference[dim - 1][i]);
  });
  held.packing = {};
  particles::ParticleSolver<dim> solver(std::move(p), std::move(force));
  solver.join({ranks, held.owner});
  const double dt = 0.3, set_up = now() - began;
  solver.compute_forces(0);

  const auto draw_apart = [&](double by) {
    particles::for_each(solver.state.part.owned, [&](int i) {
      const bool right = solver.state.reference[0][i] > width_of<dim>(n_particles) / 2;
      solver.state.displacement[0][i] = right ? by / 2 : -by / 2;
    });
  };
  const double reach = 2 * law.energy / law.strength.value;
  if (softens) {
    draw_apart(0.01 * reach);
    solver.update_ghosts();
    solver.compute_forces(dt / 2);
  }
  double in_halo = 0, in_forces = 0;
  ranks.any(false); // all begin together
  began = now();
  for (int s = 1; s <= steps; ++s) {
    if (softens)
      draw_apart(reach * (0.01 + 0.3 * s / steps));
    else {
      solver.kick(dt);
      solver.drift(dt);
    }
    const double drifted = now();
    solver.update_ghosts();
    const double updated = now();
    solver.compute_forces(s * dt);
    in_halo += updated - drifted;
    in_forces += now() - updated;
  }
  ranks.any(false);
  const double seconds = now() - began;
  const auto all = ranks.gather_all(std::vector<double>{in_halo, in_forces});
  double halo = 0, mean = 0, most = 0;
  for (std::size_t r = 0; r < all.size(); r += 2) {
    halo += all[r] / ranks.size();
    mean += all[r + 1] / ranks.size();
    most = std::max(most, all[r + 1]);
  }
  const double bytes = double(ranks.sum(std::int64_t(solver.halo().bytes(solver.state)))),
               ghosts = double(ranks.sum(std::int64_t(solver.halo().n_ghosts())));
  std::int64_t n_soft = 0, n_told = 0;
  const auto &many_body = static_cast<const dem::ManyBodyForce<dim> &>(*solver.force);
  for (const auto &[name, face] : many_body.cohesive().all()) {
    n_soft += face.is_own;
    n_told += face.is_told;
  }
  n_soft = ranks.sum(n_soft);
  n_told = ranks.sum(n_told);
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  const double memory = 1024. * double(ranks.sum(std::int64_t(usage.ru_maxrss)));
  if (ranks.rank() > 0)
    return;
  fmt::print(
      "{} particles, {} ranks, {:.0f} ghosts: {:.3f} ms a step ({:.1f} ns a particle), {:.3f} "
      "ms of it in the halo, forces {:.3f} ms (the slowest {:.2f} of the mean); {:.0f} bytes "
      "in {} messages a rank and step; set-up {:.2f} s, {:.2f} s of it the packing; {:.0f} bytes "
      "a particle at most\n",
      n, ranks.size(), ghosts, 1e3 * seconds / steps, 1e9 * seconds / steps / n, 1e3 * halo / steps,
      1e3 * mean / steps, most / mean, bytes / ranks.size(), solver.halo().n_neighbours(), set_up,
      packed, memory / double(n));
  if (softens)
    fmt::print("{} faces soften, {} of them are told to all ranks\n", n_soft, n_told);
}
} // namespace

int main(int argc, char **argv)
{
  const std::string word = argc == 5 ? argv[4] : "";
  if (argc < 4 || argc > 5 || (argc == 5 && word != "random" && word != "soften")) {
    fmt::print(stderr, "bench_ranks DIMENSION PARTICLES STEPS [random|soften]\n");
    return 2;
  }
  core::flush_denormals();
  const core::MpiJob job;
  const auto run = std::atoi(argv[1]) == 2 ? measure<2> : measure<3>;
  run(job.ranks(), std::atof(argv[2]), std::atoi(argv[3]), word);
  return 0;
}
