#include "src/simulation/recorder.h"

#include "src/output/broken_bonds.h"
#include "src/output/curve.h"
#include "src/output/run_pictures.h"
#include "src/simulation/connectivity.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace ligament::program
{
namespace
{
// Guards look this often, in steps of the far field.
constexpr long guard_interval = 50;

// Overlap bonds must not break: the run is trusted up to half their strength.
constexpr double guarded_share = 0.5;

// Fields are copied when the load has grown by this factor.
constexpr double copied_growth = 1.02;

double history_interval_of(const Scene &scene)
{
  return scene.output.history_interval > 0 ? scene.output.history_interval
                                           : scene.time.duration / 2000;
}

/// Particles of bonds that must not break.
template <int dim>
std::vector<int> guarded_particles(const CoupledBody<dim> &body)
{
  std::vector<int> guarded;
  if (body.coupler->overlap() &&
      body.force->fracture().criterion != dem::FractureLaw::Criterion::none)
    for (const auto &m : body.coupler->overlap()->members)
      guarded.push_back(m.particle);
  return guarded;
}

/// Seconds of the faster one of two calls.
template <typename Look>
double seconds_of(Look &&look)
{
  using Clock = std::chrono::steady_clock;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 2; ++k) {
    const auto start = Clock::now();
    look();
    least = std::min(least, std::chrono::duration<double>(Clock::now() - start).count());
  }
  return least;
}
} // namespace

template <int dim>
double output_seconds(const Scene &scene, const CoupledBody<dim> &body, long n_steps)
{
  const double far_steps = double(n_steps) / body.coupler->step_ratio();
  const double readings = std::min(far_steps, scene.time.duration / history_interval_of(scene));
  coupling::StepTime step;
  step.dt = body.dt;
  const TestMachine<dim> machine(body);
  double reading = 0; // keeps the compiler from leaving them out
  const double read = seconds_of([&] {
    reading += machine.read(body, 0).load + read_ledger(body, step, 0).residual() +
               crack_length(body, machine.axis());
  });
  const auto guarded = guarded_particles(body);
  const double guard = guarded.empty() ? 0 : seconds_of([&] {
    reading += body.force->utilisation(body.zone->state, guarded);
  });
  const double copy = seconds_of([&] {
    const auto particles = particle_fields(body);
    const auto cells = cell_fields(body);
  });
  // A load that grows in proportion to time: first each reading is a copy, then each growth.
  const double first = std::min(readings, 1 / (copied_growth - 1)),
               copies = first + std::log(std::max(readings / first, 1.)) / std::log(copied_growth) +
                        scene.time.duration / scene.output.field_interval;
  return std::isfinite(reading)
             ? readings * read + far_steps / guard_interval * guard + copies * copy
             : 0;
}

template <int dim>
Recorder<dim>::Recorder(const Scene &scene, const RunFolder &folder, const CoupledBody<dim> &body,
                        core::Log &log, core::Timers &timers, std::FILE *progress, long n_steps,
                        bool draws_pictures)
    : scene_(scene), folder_(folder), log_(log), timers_(timers),
      section_(timers.section("output")), machine_(body),
      history_(folder.history(), history_columns(dim)),
      progress_(progress, dim, scene.output.progress_interval), fields_(folder, dim),
      n_steps_(n_steps), draws_pictures_(draws_pictures),
      history_interval_(history_interval_of(scene)), guarded_(guarded_particles(body))
{
}

template <int dim>
std::optional<Stop> Recorder<dim>::observe(const CoupledBody<dim> &body,
                                           const coupling::StepTime &step, double damping)
{
  const long far_step = step.step / body.coupler->step_ratio();
  const bool guard = far_step % guard_interval == 0;
  const bool history = step.time >= next_history_ - 1e-9 * history_interval_;
  const bool fields = step.time >= next_fields_;
  const bool progress = far_step % 20 == 0 && progress_.is_due();
  if (!guard && !history && !fields && !progress)
    return {};
  const auto timing = timers_.scope(section_);
  if (history) {
    record_history(body, step, damping);
    if (!std::isfinite(residual_.back()))
      return Stop{true, fmt::format("the energies are no longer finite at {:.4g} s: the run is "
                                    "unstable; lower /time/step_fraction or the load's rate",
                                    step.time)};
  }
  if (fields)
    record_fields(body, step);
  if (progress)
    progress_.print(progress_state(body, step, read_ledger(body, step, damping)));
  if (guard)
    return check_guards(body, step);
  return {};
}

template <int dim>
void Recorder<dim>::record_history(const CoupledBody<dim> &body, const coupling::StepTime &step,
                                   double damping)
{
  next_history_ += history_interval_;
  const Reading r = machine_.read(body, step.time);
  const EnergyLedger ledger = read_ledger(body, step, damping);
  history_.set("time", step.time);
  history_.set("step", double(step.step));
  history_.set("load", r.load);
  history_.set("stress", r.stress);
  history_.set("displacement", r.displacement);
  history_.set("strain", r.strain);
  for (const auto &[name, value] : ledger.channels())
    history_.set(name, value);
  history_.set("broken_bonds", body.force ? double(body.force->broken_bonds().size()) : 0);
  history_.set("crack_length", crack_length(body, machine_.axis()));
  history_.end_row();

  if (!broken_ || step.time <= break_.felt_at) {
    time_.push_back(step.time);
    load_.push_back(r.load);
    stress_.push_back(r.stress);
    strain_.push_back(r.strain);
  }
  residual_.push_back(ledger.residual());
  work_.push_back(ledger.external_work);
  // A crack that runs moves within microseconds, while the grips still feel a rising load: the
  // states before it are the ones to show and to compare.
  if (ledger.kinetic() < 0.01 * ledger.potential())
    keep_copies(body, step.time, r.load);
}

// Which state is the last before fracture is known only later: copies are kept on the way up, of
// the motion at the times that other runs of the scene copy it too, of the fields, which take
// longer, as the load grows.
template <int dim>
void Recorder<dim>::keep_copies(const CoupledBody<dim> &body, double time, double load)
{
  if (const int index = common_time_index(time); index > common_time_) {
    common_time_ = index;
    std::rotate(snapshots_.begin(), snapshots_.end() - 1, snapshots_.end());
    snapshots_[0] = snapshot(body, time);
  }
  if (std::abs(load) > copied_growth * std::abs(fields_copied_at_)) {
    fields_copied_at_ = load;
    peak_state_ = present_state(body, time);
  }
}

template <int dim>
void Recorder<dim>::record_fields(const CoupledBody<dim> &body, const coupling::StepTime &step)
{
  next_fields_ += scene_.output.field_interval;
  BodyState state = present_state(body, step.time);
  state.bonds = broken_bonds(body);
  state_fields_.complete(body, state);
  writer_.submit([this, state = std::move(state)] { fields_.write(state); });
}

template <int dim>
BodyState Recorder<dim>::present_state(const CoupledBody<dim> &body, double time) const
{
  BodyState state;
  state.time = time;
  state.particles = particle_fields(body);
  state.cells = cell_fields(body);
  return state;
}

template <int dim>
std::optional<Stop> Recorder<dim>::report_excess(const std::string &finding,
                                                 const coupling::StepTime &step)
{
  const std::string reason = fmt::format("at {:.4g} s {}", step.time, finding);
  log_.warning(reason);
  if (scene_.coupling.guard == "stop")
    return Stop{true, reason};
  return {};
}

template <int dim>
std::optional<Stop> Recorder<dim>::check_guards(const CoupledBody<dim> &body,
                                                const coupling::StepTime &step)
{
  // Overlap bonds must not break.
  if (!guarded_.empty() && !warned_) {
    const double utilisation = body.force->utilisation(body.zone->state, guarded_);
    if (utilisation > guarded_share) {
      warned_ = true;
      if (const auto stop = report_excess(
              fmt::format("the tension in the overlap is {:.0f} % of the strength: fracture comes "
                          "near it; make /discrete_zone/region larger",
                          100 * utilisation),
              step))
        return stop;
    }
  }
  if (body.force && !broken_)
    look_for_break(body, step.time);
  if (broken_ && step.time >= break_.felt_at && scene_.time.stop_when == "specimen_broken")
    return Stop{false, fmt::format("specimen broken at {:.4g} s", break_.time)};
  return {};
}

// The sides feel the break when a wave from it has reached them; what they feel later is the swing
// of the halves, which is no load that the specimen carries.
template <int dim>
void Recorder<dim>::look_for_break(const CoupledBody<dim> &body, double time)
{
  const auto &bonds = body.force->broken_bonds();
  if (bonds.size() == broken_before_)
    return;
  broken_before_ = bonds.size();
  const int axis = machine_.axis();
  if (!is_broken_across(body, axis))
    return;
  broken_ = true;
  break_state_ = present_state(body, time);
  const double place = bonds.back().position[axis];
  const double way = std::max(body.upper[axis] - place, place - body.lower[axis]);
  break_.time = bonds.back().time;
  break_.felt_at = break_.time + way / body.force->elastic_constants().wave_speed_p;
  log_.info("the specimen is in two at {:.4g} s; both sides feel it at {:.4g} s", break_.time,
            break_.felt_at);
}

template <int dim>
ProgressState Recorder<dim>::progress_state(const CoupledBody<dim> &body,
                                            const coupling::StepTime &step,
                                            const EnergyLedger &ledger) const
{
  ProgressState state;
  state.step = step.step;
  state.n_steps = n_steps_;
  state.time = step.time;
  state.kinetic = ledger.kinetic();
  state.potential = ledger.potential();
  state.external_work = ledger.external_work;
  state.residual = ledger.residual();
  state.broken_bonds = body.force ? std::int64_t(body.force->broken_bonds().size()) : 0;
  state.crack_length = crack_length(body, machine_.axis());
  return state;
}

template <int dim>
std::vector<std::string> Recorder<dim>::shown_fields() const
{
  std::vector<std::string> words;
  for (const PictureParameters &picture : scene_.output.pictures)
    words.push_back(picture.field);
  if (words.empty())
    words.push_back(machine_.has_load() ? fmt::format("stress_{0}{0}", "xyz"[machine_.axis()])
                                        : "equivalent_stress");
  return words;
}

template <int dim>
void Recorder<dim>::keep_states(const CoupledBody<dim> &body, std::vector<BodyState> states,
                                RunRecord &record)
{
  if (!draws_pictures_)
    return;
  const auto bonds = broken_bonds(body);
  std::vector<const BodyState *> all;
  for (BodyState &state : states) {
    const auto later = std::find_if(bonds.begin(), bonds.end(),
                                    [&](const BrokenBond &b) { return b.time > state.time; });
    state.bonds.assign(bonds.begin(), later);
    state_fields_.complete(body, state);
    const StateFiles files = FieldSeries::files(state, state.name);
    record.states.push_back({state.name, state.caption, state.time, files.particles, files.cells});
    all.push_back(&state);
  }
  writer_.submit([&] {
    for (const BodyState &state : states)
      fields_.write(state);
  });
  record.magnification =
      scene_.output.magnification > 0 ? scene_.output.magnification : good_magnification(all);
  record.pictures = write_pictures(folder_, all, shown_fields(), dim, record.magnification);
  writer_.wait();
}

template <int dim>
void Recorder<dim>::finish(const CoupledBody<dim> &body, const coupling::StepTime &step,
                           double damping, RunRecord &record)
{
  const auto timing = timers_.scope(section_);
  record_history(body, step, damping);
  history_.flush();
  progress_.finish(progress_state(body, step, read_ledger(body, step, damping)));
  write_broken_bonds(folder_.broken_bonds(), broken_bonds(body), dim);
  if (!body.cut_faces.empty())
    write_broken_bonds(folder_.cut_faces(), body.cut_faces, dim);
  for (std::size_t i = 0; i < snapshots_.size(); ++i)
    if (body.zone && snapshots_[i])
      write_snapshot(folder_.snapshots()[i], *snapshots_[i]);

  std::vector<BodyState> states;
  const auto keep = [&](BodyState state, const char *name, const char *caption) {
    state.name = name;
    state.caption = caption;
    states.push_back(std::move(state));
  };
  if (const auto peak = peak_index(load_)) {
    record.peak_load = load_[*peak];
    record.peak_stress = stress_[*peak];
    record.peak_time = time_[*peak];
    keep(std::move(peak_state_), "peak", "near the peak load");
  }
  if (broken_)
    keep(std::move(break_state_), "broken", "when the specimen is in two");
  keep(present_state(body, step.time), "end", "at the end");
  keep_states(body, std::move(states), record);
  record.stiffness = fit_stiffness(strain_, stress_);
  record.broken_bonds = body.force ? std::int64_t(body.force->broken_bonds().size()) : 0;
  record.crack_length = crack_length(body, machine_.axis());
  record.energy_residual = relative_residual(residual_, work_);
}

template double output_seconds(const Scene &, const CoupledBody<2> &, long);
template double output_seconds(const Scene &, const CoupledBody<3> &, long);
template class Recorder<2>;
template class Recorder<3>;
} // namespace ligament::program
