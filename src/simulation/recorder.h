// The observers of a run: history, fields, peak, progress line, guards and the end of the scene.
#pragma once

#include "core/background_writer.h"
#include "core/state.h"
#include "src/drawing/run_pictures.h"
#include "src/output/progress.h"
#include "src/output/run_folder.h"
#include "src/output/vtk.h"
#include "src/simulation/body_fields.h"
#include "src/simulation/history_rows.h"
#include "src/simulation/load_curve.h"
#include "src/simulation/load_path.h"
#include "src/simulation/overlap_guard.h"
#include "src/simulation/snapshot_keeper.h"

#include <optional>

namespace ligament::program
{
/// Why a run ends before its last step.
struct Stop
{
  bool by_guard;
  std::string reason;
};

/// What the looks of a whole run of so many steps take in its loop, in s: readings and copies of
/// fields; each kind is timed once. For a prediction; the body is at rest.
template <int dim>
double output_seconds(const Scene &scene, const CoupledBody<dim> &body, long n_steps);

/// Everything that looks at the body between forces and kick, each part with its own trigger. Only
/// called in steps in which both models stand at the same time. Of several ranks, which look alike,
/// each keeps what it owns, and the first one writes.
template <int dim>
class Recorder
{
public:
  Recorder(const Scene &scene, const RunFolder &folder, const CoupledBody<dim> &body,
           core::Log &log, core::Timers &timers, std::FILE *progress, long n_steps,
           bool draws_pictures, bool goes_on = false);

  /// From now on each rank writes the fields of its own particles.
  void write_pieces() { writes_pieces_ = true; }

  /// Looks at the present state; empty while the run goes on. `damping` in J so far.
  std::optional<Stop> observe(const CoupledBody<dim> &body, const coupling::StepTime &step,
                              double damping);

  /// A reading that counts for the peak and has no row: bonds broke in the same step.
  void see_load(double time, const Reading &reading, std::int64_t n_broken)
  {
    curve_.look(time, reading, n_broken);
  }

  /// Until it is said again: whether observe() looks at equilibria of a static phase. Each of them
  /// is a row of the history.
  void in_static_phase(bool is_static) { in_static_phase_ = is_static; }

  /// Logs what leaves the range of the models, from when on nothing counts; a stop when the scene's
  /// guard says so.
  std::optional<Stop> report_excess(const std::string &finding, const coupling::StepTime &step);

  /// Logs what is no state of the body any more, from when on nothing counts.
  Stop stop_by_guard(const std::string &finding, const coupling::StepTime &step);
  /// The run ends within a step, where the state of the body can't be looked at: finish() completes
  /// what has been seen before.
  void look_no_more() { can_look_ = false; }

  /// Last row, last fields, pictures, tables; completes the record. A file that cannot be written
  /// does not keep the others from it: pictures are missed with a warning, the rest is a failure().
  /// No picture is begun after `pictures_until`.
  void finish(const CoupledBody<dim> &body, const coupling::StepTime &step, double damping,
              RunRecord &record, std::optional<PictureTime> pictures_until = {});

  /// Waits for the fields that are being written; throws what kept them from it.
  void wait() { writer_.wait(); }
  /// Puts the files that grow onto the disk and says how long they are, by their names in the
  /// folder; EnvironmentError when it refuses.
  std::map<std::string, std::int64_t> sync();
  /// After wait().
  void save(core::State &state) const;
  /// The copies of earlier times, which checkpoints keep beside it; to be taken before the next
  /// look, on all ranks at once: the first one gets them.
  std::vector<KeptState> kept(const CoupledBody<dim> &body) const;
  /// The body has its motion already. Copies that are lost are missing in the outputs. `now` in s.
  void load(const core::State &state, const std::map<std::string, core::State> &kept,
            const CoupledBody<dim> &body, double now);
  /// The part of load() that goes by particles.
  void load_copies(const core::State &state, const std::map<std::string, core::State> &kept,
                   const CoupledBody<dim> &body);
  /// Where a run goes on.
  void start_at(long step) { first_step_ = step; }

  /// A new body with the state of the one that it took the place of, maybe cut otherwise for ranks:
  /// then load_copies() has to follow.
  void watch(const CoupledBody<dim> &body);

  /// The first file that finish() could not write, and why; empty: none.
  const std::string &failure() const { return failure_; }

private:
  template <typename Write>
  void attempt(Write &&write);
  std::optional<Stop> look_at_flow(const CoupledBody<dim> &body, const coupling::StepTime &step);
  std::optional<Stop> look_at_balance(const EnergyLedger &ledger, const CoupledBody<dim> &body,
                                      const coupling::StepTime &step);
  /// A row; returns its energies. The last one is not written twice.
  EnergyLedger record_history(const CoupledBody<dim> &body, const coupling::StepTime &step,
                              double damping, bool is_last = false);
  bool is_row_due(double time) const;
  /// By more than so many steps of the far field, of this length in s.
  bool rows_are_apart(long far_steps, double far_step) const;
  /// Whether a row of its own is to tell of faces that broke, unless the scene says when rows are.
  bool breaks_between_rows(const CoupledBody<dim> &body, const coupling::StepTime &step) const;
  bool keeps_copies(const CoupledBody<dim> &body) const;
  void keep_copies(const CoupledBody<dim> &body, double time, double load);
  void record_fields(const CoupledBody<dim> &body, const coupling::StepTime &step);
  /// The present fields without those that StateFields adds.
  BodyState present_state(const CoupledBody<dim> &body, double time) const;
  /// Of the pictures, in words of shown_field().
  std::vector<std::string> shown_fields() const;
  /// The fields of a completed state of the particles at hand.
  void write_fields(const CoupledBody<dim> &body, BodyState state);
  /// What a rank writes of them.
  Piece piece(const CoupledBody<dim> &body) const;
  /// Completes, writes and draws what the run keeps.
  void keep_states(const CoupledBody<dim> &body, std::vector<BodyState> kept, RunRecord &record,
                   std::optional<PictureTime> pictures_until);
  std::string report(const std::string &finding, const coupling::StepTime &step);
  void look_for_break(const CoupledBody<dim> &body, const coupling::StepTime &step);
  void write_bonds(const std::string &path, const std::vector<BrokenBond> &bonds) const;
  void add_warnings(const CoupledBody<dim> &body, RunRecord &record) const;
  ProgressState progress_state(const CoupledBody<dim> &body, const coupling::StepTime &step,
                               const EnergyLedger &ledger) const;

  const Scene &scene_;
  RunFolder folder_;
  core::Log &log_;
  core::Timers &timers_;
  const int section_;
  TestMachine<dim> machine_;
  HistoryRows<dim> history_;
  Progress progress_;
  FieldSeries fields_;
  long n_steps_, first_step_ = 0;
  bool draws_pictures_, writes_, writes_pieces_ = false, in_static_phase_ = false, can_look_ = true;
  double history_interval_;
  double next_history_ = 0, next_fields_ = 0; // s
  std::int64_t broken_in_rows_ = 0;           // faces at the last row
  OverlapGuard<dim> guard_;
  LoadPath<dim> path_;
  std::optional<double> broken_time_;   // s, of the last bond when the load path was gone
  std::optional<double> trusted_until_; // s
  std::string failure_;

  LoadCurve curve_;
  LedgerExtremes extremes_; // of the rows of the history and the looks between sparse ones
  SnapshotKeeper<dim> snapshots_;
  bool quasi_static_ = true;             // at the last row
  double fields_copied_at_ = 0;          // N, load of the copies below
  BodyState peak_state_;                 // without bonds until the end
  std::optional<BodyState> break_state_; // when the load path was found gone
  StateFields<dim> state_fields_;
  core::BackgroundWriter writer_; // of fields_; last, so that its jobs end before what they use
};
} // namespace ligament::program
