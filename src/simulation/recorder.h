// The observers of a run: history, fields, peak, progress line, guards and the end of the scene.
#pragma once

#include "core/background_writer.h"
#include "src/output/history.h"
#include "src/output/progress.h"
#include "src/output/run_folder.h"
#include "src/output/snapshot.h"
#include "src/output/vtk.h"
#include "src/simulation/body_fields.h"
#include "src/simulation/energy_ledger.h"
#include "src/simulation/test_machine.h"

#include <array>
#include <limits>
#include <optional>

namespace ligament::program
{
/// Why a run ends before its last step.
struct Stop
{
  bool by_guard;
  std::string reason;
};

/// What the looks of a whole run of so many steps take in its loop, in s: readings, guards, copies
/// of fields; each kind is timed once. For a prediction; the body is at rest.
template <int dim>
double output_seconds(const Scene &scene, const CoupledBody<dim> &body, long n_steps);

/// Everything that looks at the body between forces and kick, each part with its own trigger. Only
/// called in steps in which both models stand at the same time.
template <int dim>
class Recorder
{
public:
  Recorder(const Scene &scene, const RunFolder &folder, const CoupledBody<dim> &body,
           core::Log &log, core::Timers &timers, std::FILE *progress, long n_steps,
           bool draws_pictures);

  /// Looks at the present state; empty while the run goes on. `damping` in J so far.
  std::optional<Stop> observe(const CoupledBody<dim> &body, const coupling::StepTime &step,
                              double damping);

  /// Logs what leaves the range of the models; a stop when the scene's guard says so.
  std::optional<Stop> report_excess(const std::string &finding, const coupling::StepTime &step);

  /// Last row, last fields, pictures, tables; completes the record.
  void finish(const CoupledBody<dim> &body, const coupling::StepTime &step, double damping,
              RunRecord &record);

private:
  void record_history(const CoupledBody<dim> &body, const coupling::StepTime &step, double damping);
  void keep_copies(const CoupledBody<dim> &body, double time, double load);
  void record_fields(const CoupledBody<dim> &body, const coupling::StepTime &step);
  /// The present fields without those that StateFields adds.
  BodyState present_state(const CoupledBody<dim> &body, double time) const;
  /// Of the pictures, in words of shown_field().
  std::vector<std::string> shown_fields() const;
  /// Completes, writes and draws what the run keeps.
  void keep_states(const CoupledBody<dim> &body, std::vector<BodyState> states, RunRecord &record);
  std::optional<Stop> check_guards(const CoupledBody<dim> &body, const coupling::StepTime &step);
  void look_for_break(const CoupledBody<dim> &body, double time);
  ProgressState progress_state(const CoupledBody<dim> &body, const coupling::StepTime &step,
                               const EnergyLedger &ledger) const;

  const Scene &scene_;
  RunFolder folder_;
  core::Log &log_;
  core::Timers &timers_;
  const int section_;
  TestMachine<dim> machine_;
  HistoryWriter history_;
  Progress progress_;
  FieldSeries fields_;
  long n_steps_;
  bool draws_pictures_;
  double history_interval_;
  double next_history_ = 0, next_fields_ = 0; // s
  std::size_t broken_before_ = 0;             // at the last check of connectivity
  bool broken_ = false;                       // no bond or cell joins the two sides
  struct
  {
    double time = 0, felt_at = 0; // s, of the last bond; when a P wave has reached both sides
  } break_;
  std::vector<int> guarded_; // overlap particles
  bool warned_ = false;

  // What the record needs from the history; loads up to the time when the sides feel the break.
  std::vector<double> load_, stress_, strain_, time_, residual_, work_;
  std::array<std::optional<Snapshot>, 2> snapshots_;  // the later one first
  int common_time_ = std::numeric_limits<int>::min(); // index of the last one
  double fields_copied_at_ = 0;                       // N, load of the copies below
  BodyState peak_state_;                              // without bonds until the end
  BodyState break_state_;                             // when the specimen was found in two
  StateFields<dim> state_fields_;
  core::BackgroundWriter writer_; // of fields_; last, so that its jobs end before what they use
};
} // namespace ligament::program
