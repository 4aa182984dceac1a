// Stability under stress: shapes and loads at the edge of what the set-up accepts.
#include "src/simulation/energy_ledger.h"
#include "src/simulation/regime_control.h"
#include "src/verification/bodies/unit_bodies.h"
#include "src/verification/cases/stability.h"
#include "src/verification/instruments/linear_motion.h"
#include "src/verification/instruments/noise_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
constexpr double strain = 1e-8;

/// The critical step over the one that the set-up calls stable, and the energy of 5000 steps of
/// undamped noise.
template <int dim>
void judge(const std::string &name, const Scene &scene, std::vector<Result> &results)
{
  UnitBody<dim> unit(scene);
  {
    LinearMotion<dim> motion(unit.body);
    results.push_back({name + "/margin",
                       2 / motion.largest_frequency() / unit.body.dt_zone,
                       1,
                       {},
                       Result::Bound::at_least});
    motion.rest();
  }
  const auto energy = run_noise(unit.body, strain, 5000, 5, 0).leap_frog;
  results.push_back({name + "/fluctuation", course_of(energy, 5).fluctuation, strain, {}});
}

/// The least that a scene may leave between two overlaps is 8 spacings.
template <int dim>
Scene thin(const std::string &packing, int overlap_cells)
{
  const double h = dim == 2 ? 4.1 : 3.1, zone = 2 * overlap_cells * h + 8.01;
  Scene scene =
      dim == 2 ? unit_scene(2, {17, zone + 40, 0}, 0.3) : unit_scene(3, {6.3, 6.7, zone + 36}, 0.3);
  scene.zone.packing = named<PackingKind>(packing);
  scene.coupling.overlap_cells = overlap_cells;
  scene.coupling.transition_cells = 3;
  add_far_field(scene, dim == 2 ? Point{0, zone, 0} : Point{0, 0, zone}, h);
  return scene;
}

std::vector<Result> thin_zone()
{
  std::vector<Result> results;
  judge<2>("stability_thin/hexagonal", thin<2>("hexagonal", 2), results);
  judge<2>("stability_thin/random", thin<2>("random", 2), results);
  judge<3>("stability_thin/fcc", thin<3>("fcc", 3), results);
  return results;
}

/// Two notches leave a neck of about one particle in the middle of the zone.
Scene necked(const std::string &packing)
{
  Scene scene = unit_scene(2, {21, 94, 0}, 0.3);
  scene.zone.packing = named<PackingKind>(packing);
  scene.coupling.transition_cells = 3;
  add_far_field(scene, {0, 46, 0}, 4.1);
  scene.specimen.notches.push_back({{-11, -2.2, 0}, {-0.55, 2.2, 0}});
  scene.specimen.notches.push_back({{0.55, -2.2, 0}, {11, 2.2, 0}});
  return scene;
}

std::vector<Result> neck()
{
  std::vector<Result> results;
  for (const char *packing : {"hexagonal", "square", "random"})
    judge<2>(std::string("stability_neck/") + packing, necked(packing), results);
  return results;
}

/// The top moves in at a speed of `impact` c_P from the first step on.
Scene struck(bool zone_at_the_top, double impact)
{
  Scene scene = unit_scene(2, {17, 94, 0}, 0.3);
  add_far_field(scene, {0, 46, 0}, 4.1);
  if (zone_at_the_top) {
    scene.zone.lower[1] = 0;
    scene.zone.upper[1] = scene.specimen.size[1];
  }
  scene.coupling.transition_cells = 3;
  scene.coupling.regime = RegimeChoice::automatic;
  scene.coupling.fine_damper = 8;
  scene.coupling.gap_filter = 4;
  LoadParameters load;
  load.boundary = 3;
  load.kind = LoadKind::velocity;
  const double nu = 0.3, c_p = std::sqrt((1 - nu) / (1 + nu) / (1 - 2 * nu));
  load.value[1] = load.velocity[1] = -impact * c_p;
  scene.loads.push_back(load);
  return scene;
}

/// The run ends where the regime's control gives a reason, as `run` does: until then every joule is
/// explained.
void strike(const std::string &name, const Scene &scene, std::vector<Result> &results)
{
  UnitBody<2> unit(scene);
  auto &body = unit.body;
  RegimeControl<2> control(scene.coupling.regime, body);
  auto bodies = body.bodies();
  coupling::StepTime step;
  step.dt = body.dt;
  double residual = 0, work = 0, start = 0;
  body.coupler->compute_forces(bodies, step);
  bool within = true;
  while (within && step.time < 200) {
    if (const auto reason = control.look(body, step, unit.log)) {
      fmt::print("  {} ends at t = {:.1f}: {}\n", name, step.time, *reason);
      within = false;
    }
    const auto ledger = read_ledger(body, step, 0);
    if (step.step == 0)
      start = ledger.residual();
    keep_largest(work, std::abs(ledger.external_work));
    keep_largest(residual, std::abs(ledger.residual() - start));
    body.coupler->kick(bodies, step);
    body.coupler->drift(bodies, step);
    ++step.step;
    step.time = double(step.step) * step.dt;
    body.coupler->compute_forces(bodies, step);
  }
  results.push_back({name + "/residual", residual / work, 1e-3, {}});
}

std::vector<Result> impact()
{
  std::vector<Result> results;
  strike("stability_impact/far_field_0.02", struck(false, 0.02), results);
  strike("stability_impact/far_field_0.2", struck(false, 0.2), results);
  strike("stability_impact/zone_0.02", struck(true, 0.02), results);
  strike("stability_impact/zone_0.2", struck(true, 0.2), results);
  return results;
}
} // namespace

std::vector<Case> stress_cases()
{
  return {{"stability_thin",
           "the thinnest zone: 8 spacings between two overlaps of two cells (FCC: three)", true,
           thin_zone},
          {"stability_neck", "two notches leave a neck of one particle", true, neck},
          {"stability_impact", "struck at 0.02 and 0.2 of the wave speed", true, impact}};
}
} // namespace ligament::program
