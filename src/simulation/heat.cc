#include "src/simulation/heat.h"

#include "core/exact_sum.h"
#include "coupling/fine_scale_split.h"
#include "coupling/heated_particles.h"
#include "src/simulation/body_state.h"
#include "src/simulation/energy_ledger.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace ligament::program
{
namespace
{
// In periods of the fastest vibration.
constexpr double first_periods = 40, mean_periods = 150;

/// With the mesh held, and once more as it moves: its own heat makes the overlap push more.
template <int dim>
void find_load(const Scene &scene, CoupledBody<dim> &body, core::Log &log)
{
  auto &split = dynamic_cast<coupling::FineScaleSplit<dim> &>(*body.coupler);
  const auto start = std::chrono::steady_clock::now();
  const double period = M_PI * body.dt_zone; // the critical step is 2 over the frequency
  coupling::HeldRun run;
  run.equilibration = first_periods * period;
  run.averaging = scene.atoms->averaging > 0 ? scene.atoms->averaging : mean_periods * period;
  run.friction = std::max(scene.atoms->zone_friction, 0.1 / body.dt_zone);
  auto bodies = body.bodies();
  const auto largest = [](const auto &f) { return f.rowwise().norm().maxCoeff(); };
  const coupling::Nodal<dim> still = split.dead_load();
  const auto held = split.held_thermal_load(bodies, run, body.dt);
  split.set_dead_load(held.force, bodies);
  const core::State first = take_state(body);
  const auto free = split.free_thermal_load(bodies, run.averaging, body.dt);
  give_state(first, body);
  split.set_dead_load(free.force, bodies);

  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  const double area = std::pow(split.overlap()->cell_size, dim - 1) * body.thickness,
               force = body.far->body().stiffness(0, 0) * area; // of a strain of 1 on a cell
  log.info("thermal load: largest {:.3g} N on a node, {:.3g} N from that of atoms at rest, {:.3g} "
           "N of it by a mesh that moves; known to {:.1g} N (a strain of {:.1g}), from {} steps, "
           "{:.1f} s",
           largest(free.force),
           still.size() > 0 ? largest(coupling::Nodal<dim>(free.force - still))
                            : largest(free.force),
           largest(coupling::Nodal<dim>(free.force - held.force)), free.error, free.error / force,
           held.steps + free.steps, seconds.count());
  body.figures["thermal_load_error"] = {free.error / force, ""};
}
/// A body that nothing holds along an axis would drift that way with what the random numbers leave.
template <int dim>
void stop_drift(const Scene &scene, particles::Particles<dim> &atoms)
{
  for (int c = 0; c < dim; ++c) {
    const bool is_held =
        std::any_of(scene.loads.begin(), scene.loads.end(), [c](const LoadParameters &load) {
          return load.value[c] &&
                 (load.kind == LoadKind::velocity || load.kind == LoadKind::displacement);
        });
    if (is_held)
      continue;
    core::ExactSum momentum, mass;
    for (int i = 0; i < atoms.size(); ++i) {
      momentum.add(atoms.mass[i] * atoms.velocity[c][i]);
      mass.add(atoms.mass[i]);
    }
    const double mean = momentum.value() / mass.value();
    for (double &v : atoms.velocity[c])
      v -= mean;
  }
}
} // namespace

template <int dim>
void start_heat(const Scene &scene, CoupledBody<dim> &body, core::Log &log)
{
  auto bodies = body.bodies();
  if (auto *const alone = dynamic_cast<coupling::HeatedParticles<dim> *>(body.coupler.get())) {
    alone->start(bodies);
    stop_drift(scene, body.zone->state);
  } else
    find_load(scene, body, log);
  // The body begins with the energy of its heat.
  const coupling::StepTime first = {0, 0, body.dt};
  body.coupler->compute_forces(bodies, first);
  body.started += read_ledger(body, first, 0).residual();
}

template <int dim>
void tell_heat(Reference &reference, CoupledBody<dim> &body)
{
  const std::string error = "thermal_load_error";
  auto &figures = body.figures;
  // A run that goes on need not look for it again.
  reference.value("thermal_lattice", [&] { return figures.at("lattice_parameter").value; });
  if (const auto found = figures.find(error); found != figures.end())
    reference.value(error, [&] { return found->second.value; });
  for (const std::string &name : reference.names(error))
    figures[name] = {reference.value(name, {}), ""};
  for (const char *name : {"C11", "C12", "C33", "C44"})
    figures.erase(name); // of a body without mesh they are not asked for
  if (!body.far)
    return;
  const auto &c = body.far->body().stiffness;
  figures["C11"] = {c(0, 0), "Pa"};
  figures["C12"] = {c(0, 1), "Pa"};
  figures[dim == 2 ? "C33" : "C44"] = {c(dim, dim), "Pa"};
}

template void tell_heat(Reference &, CoupledBody<2> &);
template void tell_heat(Reference &, CoupledBody<3> &);
template void start_heat(const Scene &, CoupledBody<2> &, core::Log &);
template void start_heat(const Scene &, CoupledBody<3> &, core::Log &);
} // namespace ligament::program
