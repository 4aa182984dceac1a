// One run: the time loop, and who watches it.
#pragma once

#include "core/timers.h"
#include "src/output/run_folder.h"
#include "src/simulation/checkpoint_keeper.h"
#include "src/simulation/damping.h"
#include "src/simulation/end_request.h"
#include "src/simulation/energy_ledger.h"
#include "src/simulation/rank_balance.h"
#include "src/simulation/recorder.h"
#include "src/simulation/regime_control.h"
#include "src/simulation/servos.h"
#include "src/simulation/static_phases.h"

namespace ligament::program
{
template <int dim>
class Simulation
{
public:
  /// Builds the body (core::InputError when that can't be done) and opens the output folder. Small
  /// scenes take less time than their pictures, which may be left out. With a checkpoint the run
  /// goes on from it, and uses its states up, which are as large as the body: before run() the
  /// files that grow have to be cut back to its positions. Several ranks, which
  /// all make the same calls, run one body together; only the first one writes. What goes wrong on
  /// one of them is thrown there: it has to end the others.
  Simulation(const Scene &scene, const RunFolder &folder, std::FILE *progress,
             bool draws_pictures = true, Checkpoint *from = nullptr,
             const ForceMaker<dim> &make_force = make_zone_force<dim>,
             const core::Ranks &ranks = {});

  /// From now on the run writes checkpoints: by the interval of the scene, and where it ends before
  /// its time. `resolved`: the scene.
  void keep_checkpoints(const nlohmann::ordered_json &resolved);

  /// Every so many steps of the far field the body is built anew and takes the state of the one
  /// before, which must change nothing; the log says how often. 0: never. On several ranks it is
  /// cut elsewhere each time.
  void rebuild_every(int interval) { rebuild_interval_ = interval; }

  /// Of several ranks each writes the fields of its own particles.
  void write_pieces() { recorder_.write_pieces(); }

  /// A warning about the input, which log and record repeat.
  void warn(const std::string &text) { log_.warning(text); }

  /// Runs to the end of the scene, or until the end is asked for; writes all outputs and returns
  /// the record. A guard's stop, an end that was asked for and a disk that refuses are in the
  /// record (status "stopped", "interrupted", "failed"), not exceptions: what was computed is kept.
  RunRecord run(const EndRequest &request = {});

private:
  Clock clock_of() const;
  RunRecord make_record() const;
  /// Lets blocks of particles rest, in the state from which the loop starts.
  void let_rest();
  /// What was left out of the steps, for log and record.
  void report_rest(RunRecord &record);
  /// Takes what a checkpoint has, before the first step.
  void go_on_from(Checkpoint &checkpoint);
  /// To a body that no step has moved.
  void give(const core::State &body, const core::State &run);
  core::State run_state() const;
  /// What the recorder keeps of earlier times, on the first rank. All call it.
  std::map<std::string, core::State> kept_copies() const;
  /// Goes on with another body that no step has moved, from this state of the one before.
  void take_over(CoupledBody<dim> body, const core::State &of_body, const core::State &run);
  /// Cut for ranks by these weights of blocks of particles.
  void build_anew(const std::vector<std::int64_t> &weights);
  /// Behind the drift of a step: whether the body is to be built anew, and by which weights.
  std::optional<std::vector<std::int64_t>> new_weights();
  std::int64_t n_own() const;
  /// Of both halves and of the tools, at the present time.
  void compute_forces();
  /// Between forces and kick of a step in which the far field acts: what ends the run, or nothing.
  std::optional<Stop> look(bool is_equilibrium = false);
  /// The same of all steps that an equilibrium stands for; at its end in the last of them.
  std::optional<Stop> skip_steps();
  void book_start();
  /// What comes between forces and kick of a step in which the far field acts: false where that
  /// ends the run.
  bool look_around(bool is_calm);
  /// Kick and drift.
  void take_step();
  /// Of a body in parts that is calm: the first rank takes the whole of it, skips steps, takes the
  /// next one and deals it out again, while the others wait; where that ends the run it keeps it,
  /// and the others have nothing more to do. False where the run ends. Between two phases all hear
  /// a request for the end and write checkpoints.
  bool skip_steps_at_first(const EndRequest &request);
  /// Of a body in parts: what skip_steps_at_first() begins with.
  void keep_for_phases();
  /// The time loop; the reason when it ends early.
  std::optional<Stop> loop(const EndRequest &request);
  /// Between drift and forces of a step in which the far field acts: looks whether the end is asked
  /// for and, every so often, whether the motion is still that of a body; writes a checkpoint if
  /// the end is asked for, if one is due, or behind others at the end.
  void look_at_the_clock(const EndRequest &request);
  void write_checkpoint(const Checkpoints &checkpoints);
  void write(const RunRecord &record) const;
  /// Runs the loop and says in the record how it ended.
  void run_loop(const EndRequest &request, RunRecord &record);

  const Scene scene_;
  RunFolder folder_;
  core::Log log_;
  core::Timers timers_;
  const ForceMaker<dim> make_force_;
  Reference reference_; // of the body
  CoupledBody<dim> body_;
  RegimeControl<dim> regime_;
  BodyDamping<dim> damping_;
  Clock clock_;
  StaticPhases<dim> phases_;
  Recorder<dim> recorder_;
  Servos<dim> servos_;

  std::optional<CheckpointKeeper> keeper_;
  std::optional<core::StateFileSum> reference_sum_; // once it is on the disk
  nlohmann::ordered_json resolved_;                 // the scene, for checkpoints
  std::string started_;                             // date and time
  double setup_seconds_ = 0;
  double build_seconds_ = 0; // of the body
  RankBalance balance_;
  std::string asked_by_;     // who asked for the end; empty: nobody
  std::optional<Stop> stop_; // what ends the run before its time
  core::Ranks ranks_;
  std::vector<std::int64_t> weights_;        // by which ranks share the particles
  std::optional<core::State> before_forces_; // of the present step, where a phase may be due
  bool ends_elsewhere_ = false;              // on the first rank, which has the whole body
  int rebuild_interval_ = 0;
  long n_rebuilt_ = 0, n_broken_at_rebuild_ = 0;
};
} // namespace ligament::program
