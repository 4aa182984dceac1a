// Steps of atoms per second of processor time: copper (embedded atoms) at 300 K, for each
// instruction set, beside LAMMPS in the same run where it is installed: {name, value, unit,
// reference, ratio}, one JSON line each.
#include "bench/roofline.h"
#include "core/counter_random.h"
#include "core/dispatch.h"
#include "md/atom_force.h"
#include "md/atomic_units.h"
#include "md/crystal_packing.h"
#include "md/table_file.h"
#include "particles/particle_solver.h"

#include <fmt/format.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace
{
using namespace ligament;
using namespace ligament::md;

constexpr double dt = 2e-15; // s
constexpr int warm_up = 150, steps = 100;

void print(const std::string &name, double value, const std::string &unit, double reference)
{
  fmt::print("{{\"name\": \"{}\", \"value\": {:.4g}, \"unit\": \"{}\", \"reference\": {:.4g}, "
             "\"ratio\": {:.3f}}}\n",
             name, value, unit, reference, value / reference);
  std::fflush(stdout);
}

/// 20 x 20 x 20 cells with velocities of 600 K, half of which goes into the potential.
struct Copper
{
  Copper(const std::string &table, bool periodic, double temperature, bool keeps_neighbours)
      : crystal(read_funcfl({table}), {})
  {
    CrystalShape<3> shape;
    shape.upper = 20 * crystal.lattice_parameter() * Vector<3>::Ones();
    shape.periodic.fill(periodic);
    const auto packing = cut_crystal(crystal, shape);
    AtomForceOptions options;
    options.keeps_neighbours = keeps_neighbours;
    auto force = std::make_unique<AtomForce<3>>(crystal, packing, options);
    atoms = force.get();
    auto state = make_atoms(crystal, packing);
    for (int i = 0; i < state.size(); ++i)
      for (int c = 0; c < 3; ++c) // uniform of that variance
        state.velocity[c][i] = std::sqrt(3 * boltzmann * temperature / state.mass[i]) *
                               (2 * core::random_number(1, i, c) - 1);
    solver = std::make_unique<particles::ParticleSolver<3>>(std::move(state), std::move(force));
    solver->compute_forces(0);
  }

  void step()
  {
    solver->kick(dt);
    solver->drift(dt);
    solver->compute_forces(0);
  }

  double temperature() const // K
  {
    return 2 * solver->kinetic_energy(dt) / (3 * solver->state.size() * boltzmann);
  }

  Crystal<3> crystal;
  AtomForce<3> *atoms;
  std::unique_ptr<particles::ParticleSolver<3>> solver;
};

/// 1e6 atom-steps per second of processor time: the median of runs of some steps.
double rate(Copper &body)
{
  std::vector<double> rates;
  for (int run = 0; run < 7; ++run) {
    const double start = bench::seconds_now();
    for (int s = 0; s < steps / 5; ++s)
      body.step();
    rates.push_back(1e-6 * body.solver->state.size() * (steps / 5) /
                    (bench::seconds_now() - start));
  }
  std::sort(rates.begin(), rates.end());
  return rates[rates.size() / 2];
}

/// The same of LAMMPS; 0 where it does not run.
double lammps_rate(const std::string &table)
{
  const std::string command = fmt::format(
      "OMP_NUM_THREADS=1 OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 lmp -sf opt "
      "-in bench/peers/atoms.lmp -log none -var table {} -var steps {} 2>&1",
      table, steps);
  std::FILE *const output = popen(command.c_str(), "r");
  if (!output)
    return 0;
  double seconds = 0, share = 100, result = 0;
  char line[512];
  int n = 0, processes = 0, of = 0;
  while (std::fgets(line, sizeof(line), output)) {
    std::sscanf(line, "Loop time of %lf on %d procs for %d steps with %d atoms", &seconds,
                &processes, &of, &n);
    if (std::sscanf(line, "%lf%% CPU use", &share) == 1 && of == steps)
      result = 1e-6 * n * of / (seconds * share / 100);
  }
  pclose(output);
  return result;
}
} // namespace

/// Arguments: a funcfl table of copper, and a part of the names to be measured (empty: all). To be
/// called in the root of the sources.
int main(int argc, char **argv)
{
  const std::string table = argc > 1 ? argv[1] : "/usr/share/lammps/potentials/Cu_u3.eam";
  const std::string wanted = argc > 2 ? argv[2] : "";
  const auto measure = [&](const std::string &name, bool periodic, double temperature,
                           bool keeps_neighbours, double reference) {
    if (name.find(wanted) == std::string::npos)
      return 0.;
    Copper body(table, periodic, temperature, keeps_neighbours);
    for (int s = 0; s < warm_up; ++s)
      body.step();
    const int builds = body.atoms->list().n_builds();
    const double value = rate(body);
    print(fmt::format("{}, {} atoms at {:.3g} K, {} new lists in {} steps; reference: must", name,
                      body.solver->state.size(), body.temperature(),
                      body.atoms->list().n_builds() - builds, 7 * (steps / 5)),
          value, "1e6 atom-steps/s", reference);
    return value;
  };
  double value = 0, undisturbed = 0;
  for (const auto &[name, target] : {std::pair("plain code", HWY_SCALAR),
                                     std::pair("AVX2", HWY_AVX2), std::pair("AVX-512", HWY_AVX3)})
  {
    hwy::SetSupportedTargetsForTest(0);
    if (!(hwy::SupportedTargets() & target))
      continue;
    hwy::SetSupportedTargetsForTest(target);
    value = measure(fmt::format("copper, hot, list, periodic, {}", name), true, 600, false, 4);
    undisturbed = measure(fmt::format("copper, hot, rows, periodic, {}", name), true, 600, true, 4);
    for (const bool periodic : {true, false})
      measure(
          fmt::format("copper, cold, rows, {}, {}", periodic ? "periodic" : "free surfaces", name),
          periodic, 0.01, true, 8);
  }
  for (const bool keeps : {false, true})
    measure(fmt::format("copper, hot, {}, free surfaces", keeps ? "rows" : "list"), false, 600,
            keeps, 4);
  if (!wanted.empty())
    return 0;
  Copper body(table, true, 600, false);
  const auto list_only = [&] {
    auto list = body.atoms->list();
    list.build<3>(body.solver->state.reference, body.solver->state.displacement);
  };
  print("embedded atoms, copper, new neighbour list", 1e3 / bench::rate(list_only), "ms", 2.5);
  const double theirs = lammps_rate(table);
  if (theirs > 0) {
    print("copper, hot, list, periodic; reference: LAMMPS (eam/opt)", value, "1e6 atom-steps/s",
          theirs);
    print("copper, hot, rows, periodic; reference: LAMMPS (eam/opt)", undisturbed,
          "1e6 atom-steps/s", theirs);
  } else
    fmt::print(stderr, "not measured: lammps; to install: apt-get install lammps\n");
}
