#include "src/verification/instruments/pulled_crystal.h"

#include "src/scene/read_scene.h"
#include "src/simulation/damping.h"
#include "src/simulation/regime_control.h"
#include "src/verification/bodies/unit_bodies.h"

#include <array>
#include <cmath>
#include <ctime>

namespace ligament::program
{
namespace
{
constexpr int top = 0; // number of its load

/// What a straight line through the values of the last 5 ps, about a transit of a P wave through
/// the body, says at their end: the ends ring.
double smoothed(const std::vector<std::array<double, 2>> &values)
{
  const double end = values.back()[0];
  double n = 0, t = 0, y = 0, tt = 0, ty = 0;
  for (auto v = values.rbegin(); v != values.rend() && (*v)[0] > end - 5e-12; ++v) {
    const double s = (*v)[0] - end;
    n += 1, t += s, y += (*v)[1], tt += s * s, ty += s * (*v)[1];
  }
  return (y * tt - t * ty) / (n * tt - t * t);
}
} // namespace

PulledCrystal pull_crystal(const char *text, const std::vector<std::string> &set, int n_parted)
{
  const auto read = parse_scene(text, "crystal", set);
  core::require(read.scene.has_value(),
                read.errors.empty() ? "no scene" : core::to_string(read.errors[0]));
  PulledCrystal found{*read.scene, 0, std::nan(""), std::nan(""), {}, 0};
  UnitBody<3> unit(found.scene);
  auto &body = unit.body;
  auto bodies = body.bodies();
  found.n_atoms = body.zone->state.size();
  RegimeControl<3> regime(found.scene.coupling.regime, body);
  BodyDamping<3> damping(found.scene.damping);
  coupling::StepTime now{0, 0, body.dt};
  const auto &parted = body.force()->broken_bonds();
  body.coupler->compute_forces(bodies, now);
  std::vector<std::array<double, 2>> loads;
  const std::clock_t start = std::clock();
  while (now.time < found.scene.time.duration && int(parted.size()) < n_parted) {
    if (now.step % body.coupler->step_ratio() == 0)
      regime.look(body, now, unit.log);
    damping.before_kick(body, now);
    body.coupler->kick(bodies, now);
    damping.after_kick(body, now);
    body.coupler->drift(bodies, now);
    ++now.step;
    now.time = double(now.step) * now.dt;
    body.coupler->compute_forces(bodies, now);
    if (!std::isnan(found.load))
      continue;
    if (now.step % found.scene.coupling.step_ratio ==
        0) // the far field's reaction is that of its own steps
      loads.push_back(
          {now.time, body.force()->reaction(top)[1] + (body.far ? body.far->reaction(top)[1] : 0)});
    if (parted.empty() || loads.empty())
      continue;
    found.processor_time = double(std::clock() - start) / CLOCKS_PER_SEC;
    found.strain = 2 * body.loads[top].displacement(1, now.time) / found.scene.specimen.size[1];
    found.load = smoothed(loads);
  }
  for (const auto &bond : parted)
    found.places.push_back(bond.position);
  return found;
}
} // namespace ligament::program
