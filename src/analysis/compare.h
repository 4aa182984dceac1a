// A run beside its reference: peak load, stiffness, energy, crack path, fields, time.
#pragma once

#include "src/analysis/history_error.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace ligament::program
{
/// Errors are signed and relative, run/reference - 1. What cannot be computed stays empty, is null
/// in the JSON, and `notes` says why.
struct CompareResult
{
  bool complete = true;                     // both came to the end that their scenes ask for
  std::optional<double> peak_load_error;    // where something broke in both
  std::optional<double> largest_load_error; // where not
  std::optional<double> stiffness_error;
  /// Distance between the crack paths in particle diameters: from every broken face of one run to
  /// the nearest one of the other; the mean of both directions, and the largest of all.
  std::optional<double> crack_distance_mean;
  std::optional<double> crack_distance_max;
  /// The same over faces that broke up to the onset of fracture in their own run, and over the
  /// later ones. The onset is the time of the largest stored elastic energy: the peak as the crack
  /// sees it, before the news of it reaches the grips.
  std::optional<double> crack_distance_mean_to_onset, crack_distance_max_to_onset;
  std::optional<double> crack_distance_mean_after_onset, crack_distance_max_after_onset;
  std::optional<double> energy_error; // external work at the peak, or at the last common time
  std::optional<double> breaking_time_error; // mean time at which the faces broke
  std::optional<double> time_ratio;          // wall time of the reference over that of the run
  std::optional<double> particle_ratio;      // particles of the reference over those of the run
  /// Over particles at the same reference position, at the last common time up to 1 % before the
  /// onset or, where nothing breaks, up to the end; relative to the reference:
  /// |difference|_2/|reference|_2 and largest difference over largest value.
  std::optional<double> displacement_error, displacement_error_max;
  /// Velocities likewise. They are another matter: in a body that is all but still they are what is
  /// left of waves. `kinetic_share` says how much of its elastic energy moves, in the reference.
  std::optional<double> velocity_error, velocity_error_max, kinetic_share;
  /// Over time up to the same limit, in the same norms: load, elongation, elastic energy; kinetic
  /// energy stands apart for the same reason.
  HistoryError load_history, displacement_history, elastic_history, kinetic_history;
  /// By column: those of gauges that both runs have.
  std::map<std::string, HistoryError> gauges;
  std::optional<double> compared_until; // s
  std::int64_t matched_particles = 0;

  struct Line
  {
    std::string name, run, reference, difference;
  };
  std::vector<Line> lines;
  std::vector<std::string> notes;
  std::string plot, page;          // SVG, HTML
  std::string file_name;           // of both, without folder and extension
  std::string sides;               // what the page says of where the two lie
  std::string svg_file, html_file; // where they were written; empty until then
};

/// `reference` is the folder of another run or a CSV curve with units. InputError when one of them
/// is neither.
CompareResult compare(const std::string &run_folder, const std::string &reference);

/// Writes plot and page as compare_<reference>.svg and .html into the folder, which is made if need
/// be; where a comparison of others has these names, as compare_<reference>_2, _3, ...
/// EnvironmentError when the disk refuses.
void write_comparison(CompareResult &result, const std::string &folder);

/// Text for the terminal.
std::string table(const CompareResult &result);

/// The object that `compare --json` prints.
nlohmann::json to_json(const CompareResult &result);
} // namespace ligament::program
