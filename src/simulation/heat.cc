#include "src/simulation/heat.h"

#include "coupling/fine_scale_split.h"
#include "src/scene/atoms.h"
#include "src/simulation/energy_ledger.h"

#include <chrono>
#include <cmath>

namespace ligament::program
{
namespace
{
// In periods of the fastest vibration.
constexpr double first_periods = 40, mean_periods = 150;
} // namespace

template <int dim>
Stiffness<dim> thermal_stiffness(const Scene &scene, Reference &reference, core::Log &log)
{
  std::optional<md::CubicConstants> found;
  const auto value = [&](const char *name, double md::CubicConstants::*member) {
    return reference.value(name, [&] {
      if (!found)
        found = thermal_constants_of<dim>(scene);
      return (*found).*member;
    });
  };
  md::CubicConstants c;
  c.c11 = value("thermal_c11", &md::CubicConstants::c11);
  c.c12 = value("thermal_c12", &md::CubicConstants::c12);
  c.c44 = value("thermal_c44", &md::CubicConstants::c44);
  c.error = value("thermal_c_error", &md::CubicConstants::error);
  const auto crystal = crystal_of<dim>(scene);
  log.info("crystal at {} K: lattice parameter {:.6g} m, C11, C12, C44 of its cube {:.4g}, {:.4g}, "
           "{:.4g} Pa (+- {:.1g}); the overlap turns with the body from the start",
           scene.atoms->temperature, crystal.lattice_parameter(), c.c11, c.c12, c.c44, c.error);
  return md::stiffness_of<dim>(c, crystal.parameters().orientation);
}

template <int dim>
void start_heat(const Scene &scene, CoupledBody<dim> &body, core::Log &log)
{
  auto *const split = dynamic_cast<coupling::FineScaleSplit<dim> *>(body.coupler.get());
  if (!split)
    return;
  const auto start = std::chrono::steady_clock::now();
  const double period = M_PI * body.dt_zone; // the critical step is 2 over the frequency
  coupling::HeldRun run;
  run.equilibration = first_periods * period;
  run.averaging = scene.atoms->averaging > 0 ? scene.atoms->averaging : mean_periods * period;
  run.friction = std::max(scene.atoms->zone_friction, 0.1 / body.dt_zone);
  auto bodies = body.bodies();
  const auto report = split->find_thermal_load(bodies, run, body.dt);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  const double area = std::pow(split->overlap()->cell_size, dim - 1) * body.thickness,
               force = body.far->body().stiffness(0, 0) * area; // of a strain of 1 on a cell
  log.info(
      "thermal load: largest {:.3g} N on a node, {:.3g} N from that of atoms at rest, known to "
      "{:.1g} N (a strain of {:.1g}), from {} steps with the mesh held, {:.1f} s",
      report.load, report.change, report.error, report.error / force, report.steps,
      seconds.count());
  body.figures["thermal_load_error"] = {report.error / force, ""};
  // The body begins with the energy of its heat.
  const coupling::StepTime first = {0, 0, body.dt};
  split->compute_forces(bodies, first);
  body.started += read_ledger(body, first, 0).residual();
}

template Stiffness<2> thermal_stiffness<2>(const Scene &, Reference &, core::Log &);
template Stiffness<3> thermal_stiffness<3>(const Scene &, Reference &, core::Log &);
template void start_heat(const Scene &, CoupledBody<2> &, core::Log &);
template void start_heat(const Scene &, CoupledBody<3> &, core::Log &);
} // namespace ligament::program
