// A crack in copper sends out its first dislocation: coupled against the same body of atoms alone.
#include "src/verification/cases/atoms.h"
#include "src/verification/instruments/pulled_crystal.h"

#include <algorithm>
#include <cmath>

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

std::vector<Result> emission()
{
  const PulledCrystal alone = pull_crystal(body_text, {"/far_field=none"}, 1),
                      coupled = pull_crystal(body_text, {}, 1);
  const auto place = [](const PulledCrystal &c) {
    return c.places.empty() ? Vector<3>::Constant(std::nan("")) : c.places[0];
  };
  const std::string name = "atoms_emission/";
  // The body looks the same turned by 180 degrees about the front: either tip may be first.
  const auto apart = [&](double sign) {
    return (place(coupled) - sign * place(alone)).head<2>().norm() * 1e9;
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
