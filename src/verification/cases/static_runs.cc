// The cracked plate of the examples, loaded by static phases: against steps alone, its energy
// balance, its wall time at a laboratory's rate.
#include "src/verification/cases/static.h"

#include "src/scene/read_scene.h"
#include "src/simulation/simulation.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include <unistd.h>

namespace ligament::program
{
namespace
{
const char *const plate = R"({
  "title": "plate", "dimension": 2, "plane": "strain",
  "specimen": {"size": ["80 mm", "400 mm"], "cracks": [{"points": [["-10 mm", 0], ["10 mm", 0]]}]},
  "material": {"youngs_modulus": "72 GPa", "poissons_ratio": 0.22, "density": "2450 kg/m^3",
    "fracture": {"criterion": "maximum_tension", "toughness": "0.75 MPa*m^0.5"}},
  "discrete_zone": {"region": {"lower": [null, "-17.6 mm"], "upper": [null, "17.6 mm"]},
    "packing": "hexagonal", "spacing": "0.5 mm"},
  "far_field": {"cell_size": "2.07 mm", "levels": 2, "cells_per_level": 4},
  "coupling": {"overlap_cells": 3, "step_ratio": 4},
  "damping": {"local": 0},
  "loads": [{"boundary": "top", "velocity": [null, 1], "ramp": "0.4 ms"},
    {"boundary": "bottom", "velocity": [null, -1], "ramp": "0.4 ms"}],
  "time": {"duration": 1, "stop_when": "specimen_broken"},
  "output": {"field_interval": "never", "checkpoint_interval": "never", "pictures": []}
})";

/// The plate, its ends drawn apart at this speed (m/s) each.
RunRecord pull(double speed, const std::string &loading, const std::vector<std::string> &more = {})
{
  // Both break at an elongation of some 0.03 mm.
  std::vector<std::string> overrides = {
      fmt::format("/loads/0/velocity/1={}", speed), fmt::format("/loads/1/velocity/1={}", -speed),
      fmt::format("/time/duration={}", 0.06e-3 / speed), "/time/loading=" + loading};
  overrides.insert(overrides.end(), more.begin(), more.end());
  const auto input = parse_scene(plate, "plate", overrides);
  core::require(input.scene.has_value(),
                input.errors.empty() ? "no scene" : core::to_string(input.errors[0]));
  const auto path = std::filesystem::temp_directory_path() /
                    fmt::format("ligament_static_{}_{}_{}", getpid(), loading, speed);
  const RunFolder folder{path.string()};
  folder.create();
  const RunRecord record = Simulation<2>(*input.scene, folder, nullptr, false).run();
  std::filesystem::remove_all(path);
  return record;
}

std::vector<Result> ledger()
{
  const RunRecord record = pull(4e-3, "static");
  return {
      {"static_ledger/residual_over_work", record.energy_residual.value_or(std::nan("")), 1e-5,
       1e-6},
      {"static_ledger/broken_faces", double(record.broken_bonds), 50, {}, Result::Bound::at_least}};
}

// A strain rate of 1e-5/s over 400 mm.
std::vector<Result> rate()
{
  const RunRecord record = pull(2e-6, "static");
  return {
      {"static_rate/wall_seconds", record.setup_seconds + record.wall_seconds, 5, 1},
      {"static_rate/broken_faces", double(record.broken_bonds), 50, {}, Result::Bound::at_least}};
}

/// Ends that draw apart at this many mm/s in all.
std::vector<Result> peak(int opening)
{
  // The crack has run through in 20 us.
  const std::vector<std::string> rows = {"/output/history_interval=15 us"};
  const RunRecord jumps = pull(opening * 0.5e-3, "static", rows),
                  steps = pull(opening * 0.5e-3, "dynamic", rows);
  const std::string name = fmt::format("static_peak_{}_mm_per_s/", opening);
  const double nothing = std::nan("");
  const double of_jumps = jumps.peak_load.value_or(nothing),
               of_steps = steps.peak_load.value_or(nothing);
  return {{name + "load", std::abs(of_jumps / of_steps - 1), 1e-3, 2e-4},
          {name + "faces", std::abs(double(jumps.broken_bonds - steps.broken_bonds)), 0, {}}};
}
} // namespace

std::vector<Case> static_run_cases()
{
  return {
      {"static_ledger", "energy balance of a plate that is pulled by static phases", false, ledger},
      {"static_rate", "a plate at 1e-5/s: wall time", false, rate},
      {"static_peak_4_mm_per_s", "static phases against steps alone: peak load, broken faces", true,
       [] { return peak(4); }},
      {"static_peak_1_mm_per_s", "the same with steps four times slower", true,
       [] { return peak(1); }}};
}
} // namespace ligament::program
