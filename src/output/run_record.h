// What a run says about itself: the content of run.json, read by report, compare and sweep.
#pragma once

#include "core/skipped_part.h"
#include "core/timers.h"
#include "src/output/fields.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace ligament::program
{
/// A named figure of the scene or of the result, in SI units.
struct Figure
{
  double value;
  std::string unit; // "" for plain numbers
};

using core::SkippedPart;

struct PictureEntry
{
  std::string file; // relative to the output folder
  std::string caption;
};

/// What a run warned about.
struct RunWarning
{
  std::string text;
  /// J: what it took out of the energy balance, or released where the model does not hold.
  std::optional<double> energy = {};
};

/// A state that the run kept with all fields.
struct StateEntry
{
  std::string name;             // of its files: peak, broken, end
  std::string caption;          // "near the peak load"
  double time = 0;              // s
  std::string particles, cells; // files, relative to the output folder; empty: none of these
  std::vector<ToolOutline> tools = {};
};

/// A gauge of the scene, whose readings are columns of the history.
struct GaugeEntry
{
  std::string name, kind; // as the scene has them
  std::vector<std::string> columns;
  std::string text; // from what it reads
};

/// A part of a run in scenes whose loading is not dynamic: an equilibrium that was carried on to a
/// higher load, or the time steps behind a break.
struct PhaseEntry
{
  std::string kind;          // static, dynamic
  double begin = 0, end = 0; // s, times of the scene
  long steps = 0;            // done one by one
  long steps_skipped = 0;    // that an equilibrium stands for
  int solves = 0;            // of linear systems
  int iterations = 0;        // of all of them
  double load = 0;           // N, at the end; 0 where nothing has a component
  std::int64_t broken = 0;   // faces that broke in it
  std::string reason;        // why it ended
  double seconds = 0;        // wall time
};

/// Figures that are not known stay empty and are null in the file.
struct RunRecord
{
  std::string title;
  std::string version;
  std::string commit;
  std::string started;            // date and time, UTC
  std::string status = "running"; // running, done, stopped (by a guard), interrupted, failed
  std::string reason;             // why it ended
  std::string kind;               // coupled, pure_dem, pure_fem
  int dimension = 2;
  std::string plane; // strain, stress; empty in 3D

  double spacing = 0;       // m, d
  std::vector<double> size; // m, of the specimen
  double thickness = 1;     // m, 2D only

  std::int64_t particles = 0;
  std::int64_t cells = 0;
  std::int64_t overlap_particles = 0;
  /// Particles that the whole specimen would take at the same spacing.
  std::int64_t equivalent_particles = 0;

  double dt = 0;                     // s
  std::optional<double> dt_critical; // s, discrete side
  std::optional<double> dt_far;      // s, stable step of the far field
  int step_ratio = 1;
  int ranks = 1;      // that compute it together; where a run goes on, those of now
  std::string regime; // which acted, and since when; empty without mesh
  std::int64_t steps = 0;
  double simulated_time = 0; // s

  double wall_seconds = 0; // time loop
  double setup_seconds = 0;
  /// Time of the loop that moving the particles alone takes: their forces and integration, without
  /// far field, coupling and output. The verdict scales it to the pure discrete model.
  std::optional<double> discrete_seconds;
  std::vector<core::Timers::Row> timing;
  std::string verdict;
  std::vector<SkippedPart> skipped;

  /// Reaction in N, positive in tension, its stress in Pa and its time in s: the largest until the
  /// load has fallen, see LoadCurve. It is a peak when something broke before.
  std::optional<double> largest_load, largest_stress, largest_time;
  std::optional<double> peak_load, peak_stress, peak_time;
  std::optional<double> stiffness;   // Pa, see fit_stiffness
  std::optional<double> broken_time; // s, when the load path was gone
  /// When the run left the range of its models, in s: nothing later counts.
  std::optional<double> trusted_until;
  std::int64_t broken_bonds = 0;
  std::int64_t broken_in_overlap = 0;    // of them, pads excepted
  std::optional<double> crack_length;    // m (3D: m^2)
  std::optional<double> external_work;   // J, the largest of the run
  std::optional<double> energy_residual; // of work or kinetic energy, see LedgerExtremes

  /// Toughness factor c, strength, crack half length, ... by name.
  std::map<std::string, Figure> figures;
  double magnification = 0; // of displacements in pictures; 0: they show none
  std::vector<StateEntry> states;
  std::vector<PictureEntry> pictures;
  std::vector<RunWarning> warnings;
  /// In the order of time; empty, and not in the file, where loading is dynamic.
  std::vector<PhaseEntry> phases;
  /// Empty, and not in the file, where the scene has none.
  std::vector<GaugeEntry> gauges;

  /// It came to the end that its scene asks for.
  bool is_complete() const { return status == "done"; }
};

/// What to say of a run that is not complete: it "was stopped by its guard", "was interrupted",
/// "failed", "is not finished".
std::string incompleteness(const RunRecord &record);

/// Replaces the file at once; EnvironmentError when the disk refuses.
void write_run_record(const std::string &path, const RunRecord &record);

/// InputError when the file is missing, is not JSON or lacks a field.
RunRecord read_run_record(const std::string &path);
} // namespace ligament::program
