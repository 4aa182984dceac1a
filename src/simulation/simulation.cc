#include "src/simulation/simulation.h"

#include "core/version.h"
#include "packings/packing_file.h"
#include "src/analysis/verdict.h"
#include "src/simulation/doubts.h"
#include "src/simulation/guards.h"
#include "src/simulation/heat.h"
#include "src/simulation/initial_motion.h"
#include "src/simulation/named_files.h"
#include "src/simulation/whole_body.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cmath>
#include <ctime>

namespace ligament::program
{
namespace
{
Reference reference_of(const Scene &scene, const Checkpoint *from)
{
  Reference reference(from ? from->reference : core::State());
  keep_named_files(scene, reference);
  return reference;
}
} // namespace

template <int dim>
Simulation<dim>::Simulation(const Scene &scene, const RunFolder &folder, std::FILE *progress,
                            bool draws_pictures, Checkpoint *from,
                            const ForceMaker<dim> &make_force, const core::Ranks &ranks)
    : scene_(scene), folder_(folder),
      log_(ranks.is_first() ? folder.log() : "", ranks.is_first() ? progress : nullptr),
      make_force_(make_force), reference_(reference_of(scene_, from)),
      body_(make_body<dim>(scene_, log_, timers_, reference_, make_force, ranks)),
      regime_(scene_.coupling.regime, body_, scene_.is_warm(), begins_with_spin(scene_)),
      damping_(scene_.damping), clock_(clock_of()), phases_(scene_, body_, log_),
      recorder_(scene_, folder_, body_, log_, timers_, ranks.is_first() ? progress : nullptr,
                clock_.n_steps, draws_pictures, from != nullptr),
      servos_(scene_, body_, log_),
      started_(fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", fmt::gmtime(std::time(nullptr)))),
      balance_(ranks), ranks_(ranks)
{
  doubt_body(scene_, body_, log_);
  setup_seconds_ = build_seconds_ = timers_.total();
  if (!from)
    start_motion(scene_, body_);
  if (!from && scene_.is_warm())
    start_heat(scene_, body_, log_);
  if (scene_.is_warm())
    tell_heat(reference_, body_);
  if (from)
    go_on_from(*from);
  else if (body_.seeds && ranks.is_first())
    packings::write_packing_file(folder_.packing(), *body_.seeds);
}

template <int dim>
void Simulation<dim>::keep_checkpoints(const nlohmann::ordered_json &resolved)
{
  keeper_.emplace(Checkpoints(folder_.checkpoints()), scene_.output.checkpoint_interval,
                  clock_.now.step > 0);
  resolved_ = resolved;
}

// Guards look, checkpoints become due and several ranks ask each other in the same steps whatever
// the number of ranks; one process may be asked to end in any, and all between two static phases.
// No checkpoint is written of what no guard lets pass.
template <int dim>
void Simulation<dim>::look_at_the_clock(const EndRequest &request)
{
  const bool is_at_end = clock_.is_at_end();
  const bool is_guarded =
      is_at_end || clock_.now.step / body_.coupler->step_ratio() % guard_interval == 0;
  if (!body_.ranks.is_one() && !is_guarded && !phases_.goes_on())
    return;
  // Ranks hear of signals and look at clocks at different times.
  const std::vector<std::int64_t> seen =
      body_.ranks.max({request.signal(), request.is_late(), keeper_ && keeper_->has_some(),
                       keeper_ && keeper_->is_due()});
  request.hear_of(int(seen[0])); // exit codes say which signal it was
  asked_by_ = EndRequest::reason(int(seen[0]), seen[1] != 0);
  // A run that is at its end may be prolonged from there.
  const bool ends = !asked_by_.empty() || (is_at_end && seen[2] != 0);
  const bool writes = keeper_ && (ends || ((is_guarded || phases_.goes_on()) && seen[3] != 0));
  if (!is_guarded && !writes)
    return;
  if (const auto finding = find_broken_motion(body_)) {
    if (is_guarded)
      stop_ = recorder_.stop_by_guard(*finding, clock_.now);
    return;
  }
  if (!writes)
    return;
  const auto timing = timers_.scope(timers_.section("checkpoints"));
  recorder_.wait(); // a disk that refuses results ends the run, other than one for checkpoints
  keeper_->attempt(log_, [&](const Checkpoints &checkpoints) { write_checkpoint(checkpoints); });
}

template <int dim>
Clock Simulation<dim>::clock_of() const
{
  Clock clock;
  clock.now.dt = body_.dt;
  // Whole far-field steps: both models end at the same time.
  const int ratio = body_.coupler->step_ratio();
  clock.n_steps = ratio * std::lround(std::ceil(scene_.time.duration / (ratio * body_.dt)));
  return clock;
}

template <int dim>
void Simulation<dim>::let_rest()
{
  if (!body_.zone || !body_.force()->can_rest() || !body_.coupler->can_rest() ||
      scene_.time.has_phases() || // an equilibrium moves all
      scene_.body_force.is_any() || !scene_.initial_motion.empty() || !scene_.tools.empty())
    return;
  const double strain = scene_.time.rest_threshold;
  body_.zone->let_rest(particles::RestLimits::of_strain(
      strain, body_.spacing, body_.force()->elastic_constants().wave_speed_p));
  body_.coupler->let_rest(body_.bodies(), strain);
}

template <int dim>
void Simulation<dim>::report_rest(RunRecord &record)
{
  const auto report = [&](const std::string &name, const std::string &steps, double share) {
    record.figures[name] = {share, ""};
    const std::string what = fmt::format("{:.1f} % of the {}", 100 * share, steps);
    log_.info("not needed: {} (at rest until a wave arrived)", what);
    if (share > 0)
      record.skipped.push_back({what, "at rest until a wave arrived"});
  };
  if (!body_.zone || !body_.zone->rest())
    return;
  core::ExactSum share; // mean of the ranks, which own so many each
  share.add(body_.zone->rest()->share_at_rest() * particles::count(body_.zone->state.part.owned) /
            double(body_.n_particles));
  report("share_at_rest", "particle-steps", body_.ranks.sum(share).value());
  for (const auto &[name, steps, share] : body_.coupler->shares_at_rest())
    report(name, steps, share);
}

template <int dim>
void Simulation<dim>::compute_forces()
{
  auto bodies = body_.bodies();
  body_.coupler->compute_forces(bodies, clock_.now);
  if (body_.tools)
    body_.tools->act(bodies, clock_.now, body_.coupler->step_ratio());
}

template <int dim>
std::optional<Stop> Simulation<dim>::look(bool is_equilibrium)
{
  if (const auto reason = regime_.look(body_, clock_.now, log_, is_equilibrium))
    if (const auto stop = recorder_.report_excess(*reason, clock_.now))
      return stop;
  const auto stop = recorder_.observe(body_, clock_.now, damping_.energy());
  if (!stop && !servos_.empty())
    servos_.steer(body_, clock_.now.time, body_.coupler->step_ratio() * body_.dt);
  return stop;
}

template <int dim>
std::optional<Stop> Simulation<dim>::skip_steps()
{
  if (clock_.now.step > 0 && !phases_.goes_on())
    if (const auto stop = look())
      return stop;
  const auto timing = timers_.scope(timers_.section("equilibria"));
  recorder_.in_static_phase(true);
  const auto stop = phases_.advance(body_, clock_, damping_.energy(), [&] { return look(true); });
  if (const Borne borne = phases_.borne(); borne.reading)
    recorder_.see_load(borne.time, *borne.reading, borne.n_broken);
  return stop;
}

// Impulses of loads that are there at once, which the mesh takes for m steps, have (E5) and swing V
// before anything has moved, and those that meet a body in motion have F v dt/2 in its kinetic
// energy, which is that of half a step before and after: what stays as it began is no gain. Where
// equilibria come first nothing is out of balance; with heat all that the body begins with is
// booked.
template <int dim>
void Simulation<dim>::book_start()
{
  if (scene_.is_warm() || phases_.are_due(body_, clock_))
    return;
  const auto e = body_.coupler->energy(body_.bodies(), clock_.now);
  body_.started = e.kinetic_discrete + e.kinetic_far + e.impulses;
}

template <int dim>
bool Simulation<dim>::look_around(bool is_calm)
{
  if (is_calm)
    stop_ = skip_steps();
  if (stop_ || clock_.is_at_end())
    return false;
  stop_ = look(phases_.goes_on());
  if (stop_)
    return false;
  recorder_.in_static_phase(phases_.goes_on());
  return asked_by_.empty();
}

template <int dim>
void Simulation<dim>::take_step()
{
  auto bodies = body_.bodies();
  damping_.before_kick(body_, clock_.now);
  body_.coupler->kick(bodies, clock_.now); // velocities, one body in the overlap
  damping_.after_kick(body_, clock_.now);
  body_.coupler->drift(bodies, clock_.now); // positions
  clock_.advance();
}

template <int dim>
std::optional<Stop> Simulation<dim>::loop(const EndRequest &request)
{
  keep_for_phases();
  if (!phases_.goes_on())
    compute_forces();
  const int ratio = body_.coupler->step_ratio();
  if (clock_.now.step == 0) {
    book_start();
    let_rest();
  }
  while (!clock_.is_at_end()) {
    const bool far_acts = clock_.now.step % ratio == 0;
    if (far_acts && stop_)
      return stop_;
    const bool is_calm = far_acts && asked_by_.empty() && phases_.are_due(body_, clock_);
    if (is_calm && !ranks_.is_one()) {
      if (!skip_steps_at_first(request))
        return stop_;
    } else {
      if (far_acts && !look_around(is_calm))
        return stop_;
      if (phases_.goes_on()) {
        phases_.pass_step(body_, clock_, damping_.energy());
      } else {
        balance_.begin();
        take_step();
        balance_.end();
      }
    }
    if (clock_.now.step % ratio == 0)
      look_at_the_clock(request);
    if (!stop_ && asked_by_.empty())
      if (const auto weights = new_weights())
        build_anew(*weights);
    keep_for_phases();
    if (phases_.goes_on())
      continue;
    balance_.begin();
    compute_forces();
    balance_.end();
  }
  return stop_;
}

template <int dim>
RunRecord Simulation<dim>::make_record() const
{
  RunRecord r;
  r.title = scene_.title;
  r.version = core::version();
  r.commit = core::commit();
  r.started = started_;
  r.kind = !body_.far ? "pure_dem" : !body_.zone ? "pure_fem" : "coupled";
  r.dimension = dim;
  if (dim == 2)
    r.plane = scene_.plane == PlaneMode::strain ? "strain" : "stress";
  r.spacing = body_.spacing;
  for (int c = 0; c < dim; ++c)
    r.size.push_back(scene_.specimen.size[c]);
  r.thickness = body_.thickness;
  r.particles = int(body_.n_particles);
  r.cells = body_.far ? body_.far->mesh().n_cells() : 0;
  r.overlap_particles = int(n_overlap_particles(body_));
  r.equivalent_particles = body_.equivalent_particles;
  r.dt = body_.dt;
  if (body_.zone)
    r.dt_critical = body_.dt_zone;
  if (body_.far)
    r.dt_far = body_.dt_far;
  r.step_ratio = body_.coupler->step_ratio();
  r.ranks = body_.ranks.size();
  r.figures = body_.figures;
  r.skipped = body_.skipped;
  return r;
}

template <int dim>
void Simulation<dim>::run_loop(const EndRequest &request, RunRecord &record)
{
  try {
    const auto stop = loop(request);
    record.status = stop && stop->by_guard ? "stopped" : "done";
    record.reason = stop ? stop->reason : "end of the scene's duration";
    if (!stop && !clock_.is_at_end()) {
      record.status = "interrupted";
      record.reason = fmt::format("{} at {:.4g} s, in step {} of {}", asked_by_, clock_.now.time,
                                  clock_.now.step, clock_.n_steps);
    }
  } catch (const core::GuardStop &error) {
    if (!ranks_.is_one())
      throw; // the others wait
    // Within a step: places and forces are of different times, if they are numbers.
    if (!stop_)
      stop_ = recorder_.stop_by_guard(error.what(), clock_.now);
    recorder_.look_no_more();
    record.status = "stopped";
    record.reason = stop_->reason;
  } catch (const core::EnvironmentError &error) {
    if (!ranks_.is_one())
      throw; // the others wait
    record.status = "failed";
    record.reason = fmt::format("{} (at {:.4g} s, in step {} of {})", error.what(), clock_.now.time,
                                clock_.now.step, clock_.n_steps);
  }
}

template <int dim>
void Simulation<dim>::write(const RunRecord &record) const
{
  if (body_.ranks.is_first())
    write_run_record(folder_.record(), record);
}

template <int dim>
RunRecord Simulation<dim>::run(const EndRequest &request)
{
  log_.info("ligament {}, commit {}{}", core::version(), core::commit(),
            body_.ranks.is_one() ? "" : fmt::format(", on {} ranks", body_.ranks.size()));
  RunRecord record = make_record();
  record.setup_seconds = setup_seconds_;
  write(record);
  for (const auto &part : body_.skipped)
    log_.info("not needed: {} ({})", part.what, part.why);

  run_loop(request, record);
  if (ends_elsewhere_)
    return record;
  record.regime = regime_.history();
  record.phases = phases_.entries(body_, clock_);
  record.steps = clock_.now.step;
  record.simulated_time = clock_.now.time;
  record.wall_seconds = timers_.total() - record.setup_seconds;
  recorder_.finish(body_, clock_.now, damping_.energy(), record, request.limit);
  if (!recorder_.failure().empty() && record.status != "failed") {
    record.status = "failed";
    record.reason = recorder_.failure() + " (after the last step)";
  }
  servos_.put_into(record, log_);
  for (const std::string &text : log_.warnings())
    record.warnings.push_back({text});
  report_rest(record);
  record.timing = timers_.rows();
  double discrete = 0;
  for (const auto &row : record.timing)
    if (row.name == "discrete forces" || row.name == "discrete motion")
      discrete += row.seconds;
  if (body_.zone)
    record.discrete_seconds = discrete;
  record.verdict = verdict(record);
  try {
    write(record);
  } catch (const core::EnvironmentError &error) {
    record.status = "failed";
    record.reason = error.what();
  }
  if (n_rebuilt_ > 0)
    log_.info("built anew {} times, the last time with {} broken bonds", n_rebuilt_,
              n_broken_at_rebuild_);
  log_.info("{} after {} steps: {}", record.status, record.steps, record.reason);
  log_.info("time by section\n{}", core::timing_table(record.timing));
  log_.info("{}", record.verdict);
  return record;
}

template class Simulation<2>;
template class Simulation<3>;
} // namespace ligament::program
