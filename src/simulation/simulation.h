// One run: the time loop, and who watches it.
#pragma once

#include "core/interruption.h"
#include "core/timers.h"
#include "src/output/run_folder.h"
#include "src/simulation/damping.h"
#include "src/simulation/energy_ledger.h"
#include "src/simulation/recorder.h"
#include "src/simulation/regime_control.h"

namespace ligament::program
{
/// Steps of a run and where it stands.
struct Clock
{
  coupling::StepTime now;
  long n_steps = 0;

  bool is_at_end() const { return now.step >= n_steps; }
  void advance()
  {
    ++now.step;
    now.time = double(now.step) * now.dt;
  }
};

template <int dim>
class Simulation
{
public:
  /// Builds the body (core::InputError when that can't be done) and opens the output folder. Small
  /// scenes take less time than their pictures, which may be left out.
  Simulation(const Scene &scene, const RunFolder &folder, std::FILE *progress,
             bool draws_pictures = true,
             const ForceMaker<dim> &make_force = make_many_body_force<dim>);

  /// A warning about the input, which log and record repeat.
  void warn(const std::string &text) { log_.warning(text); }

  /// Runs to the end of the scene, or until a signal asks for the end; writes all outputs and
  /// returns the record. A guard's stop, a signal and a disk that refuses are in the record (status
  /// "stopped", "interrupted", "failed"), not exceptions: what was computed is kept.
  RunRecord run(const core::Interruption *interruption = nullptr);

private:
  Clock clock_of() const;
  RunRecord make_record() const;
  /// Lets blocks of particles rest, in the state from which the loop starts.
  void let_rest();
  /// What was left out of the steps, for log and record.
  void report_rest(RunRecord &record);
  /// The time loop; the reason when it ends early.
  std::optional<Stop> loop(const core::Interruption *interruption);
  /// Runs the loop and says in the record how it ended.
  void run_loop(const core::Interruption *interruption, RunRecord &record);

  const Scene scene_;
  RunFolder folder_;
  core::Log log_;
  core::Timers timers_;
  CoupledBody<dim> body_;
  RegimeControl<dim> regime_;
  BodyDamping<dim> damping_;
  Clock clock_;
  Recorder<dim> recorder_;
};
} // namespace ligament::program
