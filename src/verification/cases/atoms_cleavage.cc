// A crack in iron cleaves, coupled, with zones of two sizes, against the same body of atoms
// alone.
#include "core/extremes.h"
#include "src/verification/cases/atoms.h"
#include "src/verification/instruments/pulled_crystal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
// That of examples/iron_crack.
const char *const body_text = R"({
  "title": "cleavage",
  "dimension": 3,
  "specimen": {
    "size": ["36.48 nm", "30 nm", "2.0266 nm"],
    "periodic": [{"axis": "x"}, {"axis": "z"}],
    "cracks": [
      {"points": [["-6 nm", 0, "-5 nm"], ["6 nm", 0, "-5 nm"], ["6 nm", 0, "5 nm"], ["-6 nm", 0, "5 nm"]]}
    ]
  },
  "atoms": {"potential": "zhou", "species": "Fe", "along_x": [0, 1, -1], "along_y": [1, 0, 0]},
  "discrete_zone": {
    "packing": "bcc",
    "region": {"lower": ["-11.7 nm", "-5.7 nm", null], "upper": ["11.7 nm", "5.7 nm", null]}
  },
  "far_field": {"cell_size": "0.81 nm", "levels": 1, "growth": 1.2},
  "coupling": {"overlap_cells": 5, "transition_cells": 4, "step_ratio": 3, "fine_damper": 8, "gap_filter": 4},
  "damping": {"mass": 3e11},
  "loads": [
    {"boundary": "top", "velocity": [null, "89 m/s", null], "history": {"table": [["0 ps", 0], ["3 ps", 1], ["6 ps", 1], ["9 ps", 0.05]]}},
    {"boundary": "bottom", "velocity": [null, "-89 m/s", null], "history": {"table": [["0 ps", 0], ["3 ps", 1], ["6 ps", 1], ["9 ps", 0.05]]}}
  ],
  "time": {"duration": "26 ps", "step_fraction": 0.5}
})";

/// The zone reaches so far, in m, before the tips and above and below the crack until the overlap
/// begins.
std::vector<std::string> zone_of(double reach)
{
  const double overlap = 5 * 0.81e-9, x = 6e-9 + reach + overlap, y = reach + overlap;
  return {fmt::format("/discrete_zone/region/lower=[{}, {}, null]", -x, -y),
          fmt::format("/discrete_zone/region/upper=[{}, {}, null]", x, y)};
}

/// nm: how far from the crack's plane bonds part.
double off_plane(const PulledCrystal &c)
{
  double off = c.places.empty() ? std::nan("") : 0;
  for (const auto &place : c.places)
    keep_largest(off, std::abs(place[1]) * 1e9);
  return off;
}

std::vector<Result> cleavage()
{
  constexpr int n_parted = 40; // a spacing of the rows ahead of each tip
  const PulledCrystal alone = pull_crystal(body_text, {"/far_field=none"}, n_parted);
  const std::string name = "atoms_cleavage/";
  // The next plane of bonds lies half a lattice parameter away, 0.14 nm.
  constexpr double plane = 0.07;
  std::vector<Result> results = {{name + "alone_plane", off_plane(alone), plane, {}}};
  for (const int n : {1, 2}) {
    const PulledCrystal coupled = pull_crystal(body_text, zone_of(n * 1.65e-9), n_parted);
    const std::string what = fmt::format("{}{}_", name, n);
    results.push_back({what + "strain", std::abs(coupled.strain / alone.strain - 1), 0.01, 0.003});
    results.push_back({what + "plane", off_plane(coupled), plane, {}});
    results.push_back({what + "time", coupled.processor_time / alone.processor_time, 1, {}});
  }
  return results;
}
} // namespace

std::vector<Case> atom_cleavage_cases()
{
  return {{"atoms_cleavage", "a crack in iron cleaves, beside atoms alone", true, cleavage}};
}
} // namespace ligament::program
