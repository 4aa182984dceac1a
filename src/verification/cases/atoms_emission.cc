// A crack in copper sends out its first dislocation: coupled against the same body of atoms alone.
#include "src/scene/read_scene.h"
#include "src/simulation/regime_control.h"
#include "src/verification/bodies/unit_bodies.h"
#include "src/verification/cases/atoms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace ligament::program
{
namespace
{
// That of examples/copper_notch.
const char *const body_text = R"({
  "title": "emission", "dimension": 3,
  "specimen": {"size": ["30 nm", "26 nm", "2.045 nm"], "periodic": ["x", "z"],
    "cracks": [{"points": [["-4 nm", 0, "-5 nm"], ["4 nm", 0, "-5 nm"], ["4 nm", 0, "5 nm"],
                           ["-4 nm", 0, "5 nm"]]}]},
  "atoms": {"potential": "zhou", "species": "Cu", "along_x": [1, 1, -2], "along_y": [1, 1, 1]},
  "discrete_zone": {"packing": "fcc",
    "region": {"lower": ["-8.9 nm", "-4.9 nm", null], "upper": ["8.9 nm", "4.9 nm", null]}},
  "far_field": {"cell_size": "0.81 nm"},
  "coupling": {"overlap_cells": 4, "transition_cells": 4, "step_ratio": 6},
  "loads": [{"boundary": "top", "velocity": [null, "8 m/s", null], "ramp": "5 ps"},
            {"boundary": "bottom", "velocity": [null, "-8 m/s", null], "ramp": "5 ps"}],
  "time": {"duration": "40 ps", "step_fraction": 0.25}
})";

struct Emission
{
  double strain = std::nan(""), load = std::nan(""); // mean of the body; N
  Vector<3> place = Vector<3>::Zero();               // of the first bond that parts, m
};

/// What a straight line through the values of the last 5 ps, a transit of a P wave through the
/// body, says at their end: the ends ring.
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

Emission first_emission(const std::vector<std::string> &set)
{
  const auto read = parse_scene(body_text, "emission", set);
  core::require(read.scene.has_value(),
                read.errors.empty() ? "no scene" : core::to_string(read.errors[0]));
  const Scene &scene = *read.scene;
  UnitBody<3> unit(scene);
  auto &body = unit.body;
  auto bodies = body.bodies();
  RegimeControl<3> regime(scene.coupling.regime, body);
  coupling::StepTime now{0, 0, body.dt};
  body.coupler->compute_forces(bodies, now);
  std::vector<std::array<double, 2>> loads;
  while (now.time < scene.time.duration && body.force()->broken_bonds().empty()) {
    if (now.step % body.coupler->step_ratio() == 0)
      regime.look(body, now, unit.log);
    body.coupler->kick(bodies, now);
    body.coupler->drift(bodies, now);
    ++now.step;
    now.time = double(now.step) * now.dt;
    body.coupler->compute_forces(bodies, now);
    if (now.step % 6 == 0) // the far field's reaction is that of its own steps
      loads.push_back(
          {now.time, body.force()->reaction(0)[1] + (body.far ? body.far->reaction(0)[1] : 0)});
  }
  Emission found;
  if (body.force()->broken_bonds().empty())
    return found;
  const LoadParameters &pull = scene.loads[0];
  found.strain = 2 * *pull.value[1] * (now.time - pull.ramp / 2) / scene.specimen.size[1];
  found.load = smoothed(loads);
  found.place = body.force()->broken_bonds()[0].position;
  return found;
}

std::vector<Result> emission()
{
  const Emission alone = first_emission({"/far_field=none"}), coupled = first_emission({});
  const std::string name = "atoms_emission/";
  // The body looks the same turned by 180 degrees about the front: either tip may be first.
  const auto apart = [&](double sign) {
    return (coupled.place - sign * alone.place).head<2>().norm() * 1e9;
  };
  return {{name + "strain", std::abs(coupled.strain / alone.strain - 1), 0.02, 0.005},
          {name + "load", std::abs(coupled.load / alone.load - 1), 0.02, 0.005},
          // nm; along the plane of slip the first bonds part within two spacings.
          {name + "place", std::min(apart(1), apart(-1)), 0.6, {}}};
}
} // namespace

std::vector<Case> atom_emission_cases()
{
  return {{"atoms_emission", "a crack in copper sends out a dislocation, beside atoms alone", true,
           emission}};
}
} // namespace ligament::program
