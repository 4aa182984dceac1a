// How a run goes on with another body: after a checkpoint, cut anew, or with equilibria solved for
// by one of several ranks.
#include "algebra/parallel_multigrid.h"
#include "core/check.h"
#include "core/ranks_state.h"
#include "core/version.h"
#include "particles/instruction_set.h"
#include "src/simulation/body_state.h"
#include "src/simulation/guards.h"
#include "src/simulation/simulation.h"

#include <fmt/format.h>

namespace ligament::program
{
namespace
{
// Files of a checkpoint.
const std::string body_file = "body", run_file = "run";
} // namespace

template <int dim>
void Simulation<dim>::go_on_from(Checkpoint &checkpoint)
{
  const CheckpointManifest &manifest = checkpoint.manifest;
  core::require(
      body_.dt == manifest.dt,
      fmt::format("the step was {} s when the run began, and is {} s now", manifest.dt, body_.dt));
  for (const std::string &name : {body_file, run_file})
    core::require(checkpoint.states.count(name) > 0, "the checkpoint has no state '" + name + "'");
  const core::State &run = checkpoint.states.at(run_file);
  give(checkpoint.states.at(body_file), run);
  clock_.now.step = long(manifest.step);
  clock_.now.time = manifest.time;
  damping_.load(run);
  phases_.load(run);
  servos_.load(run);
  recorder_.load(run, checkpoint.kept, body_, clock_.now.time);
  recorder_.start_at(clock_.now.step);
  checkpoint.states.clear();
  checkpoint.kept.clear();
  setup_seconds_ += manifest.setup_seconds;
  timers_.add(manifest.timing);
  started_ = manifest.started;
  if (checkpoint.reference_lost.empty())
    reference_sum_ = manifest.reference;
  else if (scene_.zone.packing == PackingKind::file)
    core::require(core::state_file_sum(reference_.tables()) == manifest.reference,
                  "what the set-up had found is lost: " + checkpoint.reference_lost +
                      "; the run's packing.csv does not tell which rows of the packing file its "
                      "particles were, so that their motion cannot be given back; put the file "
                      "back, or repeat the run");
  log_.info("goes on from checkpoint {}, step {} of {}, {:.4g} s", manifest.number, manifest.step,
            clock_.n_steps, manifest.time);
  log_.set_warnings(manifest.warnings);
}

template <int dim>
void Simulation<dim>::give(const core::State &body, const core::State &run)
{
  let_rest(); // what moves comes with the state
  if (scene_.time.loading == Loading::sequential && body_.force())
    body_.force()->break_one_by_one(); // as from the first equilibrium on
  give_state(body, body_);
  regime_.load(run, body_);
}

template <int dim>
core::State Simulation<dim>::run_state() const
{
  core::State run;
  regime_.save(run);
  damping_.save(run);
  phases_.save(run);
  servos_.save(run);
  recorder_.save(run);
  return run;
}

template <int dim>
std::map<std::string, core::State> Simulation<dim>::kept_copies() const
{
  std::map<std::string, core::State> copies;
  for (const KeptState &kept : recorder_.kept(body_))
    copies[kept.name] = kept.take();
  return copies;
}

template <int dim>
std::int64_t Simulation<dim>::n_own() const
{
  return body_.zone ? particles::count(body_.zone->state.part.owned) : 0;
}

template <int dim>
std::optional<std::vector<std::int64_t>> Simulation<dim>::new_weights()
{
  const long ratio = body_.coupler->step_ratio(), step = clock_.now.step;
  if (rebuild_interval_ > 0)
    return step % (ratio * rebuild_interval_) == 0
               ? std::optional(body_.ranks.is_one() ? std::vector<std::int64_t>()
                                                    : balance_.shifted(n_own()))
               : std::nullopt;
  if (body_.ranks.is_one() || step % (ratio * guard_interval) != 0)
    return {};
  return balance_.look(n_own(), step, clock_.n_steps - step, build_seconds_);
}

template <int dim>
void Simulation<dim>::take_over(CoupledBody<dim> body, const core::State &of_body,
                                const core::State &run)
{
  body_ = std::move(body);
  regime_ = RegimeControl<dim>(scene_.coupling.regime, body_, scene_.is_warm());
  give(of_body, run);
  recorder_.watch(body_);
  servos_.watch(scene_, body_);
}

template <int dim>
void Simulation<dim>::build_anew(const std::vector<std::int64_t> &weights)
{
  const double begun = timers_.total();
  const auto own_before = body_.ranks.gather_all(std::vector<std::int64_t>{n_own()});
  const core::State body = core::merged(take_state(body_), body_.ranks);
  std::map<std::string, core::State> copies; // each rank keeps those of its particles
  if (!body_.ranks.is_one())
    copies = core::from_first(kept_copies(), body_.ranks);
  recorder_.wait(); // what it writes is part of the state
  const core::State run = run_state();
  core::Log nothing_new;
  weights_ = weights;
  take_over(make_body<dim>(scene_, nothing_new, timers_, reference_, make_force_, ranks_, weights_),
            body, run);
  if (!body_.ranks.is_one())
    recorder_.load_copies(run, copies, body_);
  ++n_rebuilt_;
  build_seconds_ = timers_.total() - begun;
  if (!body_.ranks.is_one()) {
    const auto own = body_.ranks.gather_all(std::vector<std::int64_t>{n_own()});
    log_.info(
        "cut anew at {:.4g} s: {} of {} particles have another rank; the slowest one took {:.0f} % "
        "longer than the mean",
        clock_.now.time, n_moved(own_before, own), body_.n_particles, 100 * balance_.imbalance());
  }
  n_broken_at_rebuild_ = body_.force() ? long(body_.force()->n_broken()) : 0;
}

template <int dim>
void Simulation<dim>::write_checkpoint(const Checkpoints &checkpoints)
{
  // What all ranks take part in comes first: a disk may refuse what follows.
  const core::State body = core::merged_at_first(take_state(body_), body_.ranks);
  const std::vector<KeptState> kept = checkpoints.taken(recorder_.kept(body_), body_.ranks);
  if (!body_.ranks.is_first())
    return;
  CheckpointManifest manifest;
  manifest.positions = recorder_.sync();
  manifest.step = clock_.now.step;
  manifest.time = clock_.now.time;
  manifest.dt = clock_.now.dt;
  manifest.started = started_;
  manifest.setup_seconds = setup_seconds_;
  manifest.wall_seconds = timers_.total() - setup_seconds_;
  manifest.timing = timers_.rows();
  manifest.warnings = log_.warnings();
  manifest.version = core::version();
  manifest.commit = core::commit();
  manifest.instructions = particles::instruction_set();
  manifest.scene = resolved_;
  if (!reference_sum_)
    reference_sum_ = checkpoints.write_reference(reference_.tables());
  manifest.reference = reference_sum_;
  checkpoints.write(std::move(manifest), {{body_file, body}, {run_file, run_state()}}, kept);
}

template <int dim>
void Simulation<dim>::keep_for_phases()
{
  before_forces_.reset();
  if (!ranks_.is_one() && clock_.now.step % body_.coupler->step_ratio() == 0 &&
      phases_.look_at(clock_))
    before_forces_ = core::merged_at_first(take_state(body_), ranks_);
}

// Equilibria are sought by one process: their systems couple all of the body; the others may help
// with multigrid. The state goes both ways between drift and forces, where it is that of the whole
// to the last bit.
template <int dim>
bool Simulation<dim>::skip_steps_at_first(const EndRequest &request)
{
  core::Log nothing_new;
  std::map<std::string, core::State> told;
  const auto copies = kept_copies();
  const bool is_helped = scene_.time.static_solver == StaticSolver::parallel_multigrid;
  recorder_.wait(); // what it writes is part of the state
  if (ranks_.is_first()) {
    const core::State run = run_state();
    take_over(make_body<dim>(scene_, nothing_new, timers_, reference_, make_force_),
              *before_forces_, run);
    recorder_.load_copies(run, copies, body_);
    phases_ = StaticPhases<dim>(scene_, body_, log_, is_helped ? ranks_ : core::Ranks());
    phases_.load(run);
    if (!phases_.goes_on())
      compute_forces();
    // Where somebody asks for the end or a checkpoint all go on behind a step that was passed, as
    // one process does.
    bool is_asked = false;
    while (!is_asked && !(ends_elsewhere_ = !look_around(true)) && phases_.goes_on()) {
      phases_.pass_step(body_, clock_, damping_.energy());
      is_asked = request.signal() != 0 || request.is_late() || (keeper_ && keeper_->is_due());
    }
    if (is_helped)
      algebra::dismiss_servers(ranks_);
    if (!ends_elsewhere_) {
      if (!is_asked)
        take_step();
      recorder_.wait();
      told[body_file] = take_state(body_);
      told[run_file] = run_state();
      for (auto &[name, copy] : kept_copies())
        told["kept " + name] = std::move(copy);
    }
  } else if (is_helped)
    algebra::serve_multigrid(ranks_);
  told = core::from_first(told, ranks_);
  if (told.empty()) {
    ends_elsewhere_ = !ranks_.is_first();
    return false;
  }
  const std::vector<std::int64_t> step = ranks_.gather_all(
      ranks_.is_first() ? std::vector<std::int64_t>{clock_.now.step} : std::vector<std::int64_t>());
  const std::vector<double> time = ranks_.gather_all(
      ranks_.is_first() ? std::vector<double>{clock_.now.time} : std::vector<double>());
  clock_.now.step = long(step[0]);
  clock_.now.time = time[0];
  const core::State &run = told[run_file];
  take_over(make_body<dim>(scene_, nothing_new, timers_, reference_, make_force_, ranks_, weights_),
            told[body_file], run);
  phases_ = StaticPhases<dim>(scene_, body_, log_);
  phases_.load(run);
  damping_.load(run);
  std::map<std::string, core::State> kept;
  for (auto &[name, state] : told)
    if (name.compare(0, 5, "kept ") == 0)
      kept[name.substr(5)] = std::move(state);
  recorder_.load(run, kept, body_, clock_.now.time);
  return true;
}

template void Simulation<2>::go_on_from(Checkpoint &);
template void Simulation<2>::give(const core::State &, const core::State &);
template core::State Simulation<2>::run_state() const;
template std::map<std::string, core::State> Simulation<2>::kept_copies() const;
template std::int64_t Simulation<2>::n_own() const;
template std::optional<std::vector<std::int64_t>> Simulation<2>::new_weights();
template void Simulation<2>::take_over(CoupledBody<2>, const core::State &, const core::State &);
template void Simulation<2>::build_anew(const std::vector<std::int64_t> &);
template void Simulation<2>::write_checkpoint(const Checkpoints &);
template void Simulation<2>::keep_for_phases();
template bool Simulation<2>::skip_steps_at_first(const EndRequest &);
template void Simulation<3>::go_on_from(Checkpoint &);
template void Simulation<3>::give(const core::State &, const core::State &);
template core::State Simulation<3>::run_state() const;
template std::map<std::string, core::State> Simulation<3>::kept_copies() const;
template std::int64_t Simulation<3>::n_own() const;
template std::optional<std::vector<std::int64_t>> Simulation<3>::new_weights();
template void Simulation<3>::take_over(CoupledBody<3>, const core::State &, const core::State &);
template void Simulation<3>::build_anew(const std::vector<std::int64_t> &);
template void Simulation<3>::write_checkpoint(const Checkpoints &);
template void Simulation<3>::keep_for_phases();
template bool Simulation<3>::skip_steps_at_first(const EndRequest &);
} // namespace ligament::program
