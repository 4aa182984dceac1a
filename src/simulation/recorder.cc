#include "src/simulation/recorder.h"

#include "core/check.h"
#include "src/analysis/curve.h"
#include "src/output/broken_bonds.h"
#include "src/output/format.h"
#include "src/simulation/gauges/j_integral.h"
#include "src/simulation/guards.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace ligament::program
{
namespace
{
// Fields are copied when the load has grown by this factor.
constexpr double copied_growth = 1.02;

// The load path is looked at this often, in steps of the far field, whether faces broke that no
// row tells of yet, and where rows are further apart the balance of energy: a run may last far
// longer than its body.
constexpr long break_interval = 50;

// Where rows are further apart than that the load is read this often, lest its peak be missed.
constexpr long load_interval = 10;

// Where equilibria take the place of steps, the steps behind a break have a row this often unless
// the scene says otherwise, in steps of the far field: such a scene lasts much longer than a break.
constexpr long phase_row_interval = 50;

// Of the external work: a change of regime that takes more is worth a warning.
constexpr double largest_regime_change = 1e-3;
// Likewise: settling that takes more is a loss that the scene did not ask for.
constexpr double largest_settled = 0.02;

template <int dim>
std::int64_t n_broken(const CoupledBody<dim> &body)
{
  return body.force() ? body.force()->n_broken() : 0;
}

double history_interval_of(const Scene &scene)
{
  return scene.output.history_interval > 0 ? scene.output.history_interval
                                           : scene.time.duration / 2000;
}

template <int dim>
double row_interval(const Scene &scene, const CoupledBody<dim> &body)
{
  const double interval = history_interval_of(scene);
  if (!scene.time.has_phases() || scene.output.history_interval > 0)
    return interval;
  return std::min(interval, phase_row_interval * body.coupler->step_ratio() * body.dt);
}

/// When the next of outputs at this distance is due. Where time jumps those in between are missed;
/// counted from the first one, they would all be made up for.
double next_output(const Scene &scene, double due, double interval, double now)
{
  return scene.time.has_phases() ? now + interval : due + interval;
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
  const double readings =
      std::min(far_steps, std::max(scene.time.duration / history_interval_of(scene),
                                   far_steps / break_interval));
  coupling::StepTime step;
  step.dt = body.dt;
  const TestMachine<dim> machine(body);
  GaugeSet<dim> gauges(scene, body);
  double reading = 0; // keeps the compiler from leaving them out
  const double read = seconds_of([&] {
    reading +=
        machine.read(body, 0).load + read_ledger(body, step, 0).residual() + crack_length(body);
    for (const double value : gauges.read(body, 0))
      reading += value;
  });
  const double copy = seconds_of([&] {
    const auto particles = particle_fields(body);
    const auto cells = cell_fields(body);
  });
  // A load that grows in proportion to time: first each reading is a copy, then each growth.
  const double first = std::min(readings, 1 / (copied_growth - 1)),
               copies = first + std::log(std::max(readings / first, 1.)) / std::log(copied_growth) +
                        scene.time.duration / scene.output.field_interval;
  return std::isfinite(reading) ? readings * read + copies * copy : 0;
}

template <int dim>
Recorder<dim>::Recorder(const Scene &scene, const RunFolder &folder, const CoupledBody<dim> &body,
                        core::Log &log, core::Timers &timers, std::FILE *progress, long n_steps,
                        bool draws_pictures, bool goes_on)
    : scene_(scene), folder_(folder), log_(log), timers_(timers),
      section_(timers.section("output")), machine_(body), history_(scene, folder, body, goes_on),
      progress_(progress, dim, scene.output.progress_interval), fields_(folder, dim),
      n_steps_(n_steps), draws_pictures_(draws_pictures), writes_(body.ranks.is_first()),
      history_interval_(row_interval(scene, body)), guard_(body), path_(machine_.axis())
{
}

template <int dim>
std::optional<Stop> Recorder<dim>::observe(const CoupledBody<dim> &body,
                                           const coupling::StepTime &step, double damping)
{
  const int ratio = body.coupler->step_ratio();
  const bool copies = keeps_copies(body);
  if (in_static_phase_)
    snapshots_.look_at_equilibrium(body, step, copies);
  else
    snapshots_.look(body, step, ratio * step.dt, copies);
  if (const auto finding = guard_.look(body, step.time))
    if (const auto stop = report_excess(*finding, step))
      return stop;
  if (step.step / ratio % OverlapGuard<dim>::flow_interval == 0)
    if (const auto stop = look_at_flow(body, step))
      return stop;
  if (!broken_time_ && (in_static_phase_ || step.step / ratio % break_interval == 0))
    look_for_break(body, step);
  if (broken_time_ && scene_.time.stop_when == StopWhen::specimen_broken)
    return Stop{false, fmt::format("specimen broken at {:.4g} s", *broken_time_)};

  if (rows_are_apart(load_interval, step.dt * ratio) && step.step % (ratio * load_interval) == 0 &&
      !in_static_phase_ && !curve_.has_ended())
    curve_.look(step.time, machine_.read(body, step.time), n_broken(body));
  const bool is_between_rows = rows_are_apart(break_interval, step.dt * ratio) &&
                               !in_static_phase_ && step.step % (ratio * break_interval) == 0;
  const bool history = in_static_phase_ || is_row_due(step.time) || breaks_between_rows(body, step);
  const bool fields = step.time >= next_fields_;
  const bool progress = step.step / ratio % 20 == 0 && body.ranks.any(progress_.is_due());
  if (!history && !fields && !progress && !is_between_rows)
    return {};
  const auto timing = timers_.scope(section_);
  if (history || is_between_rows) {
    const EnergyLedger ledger =
        history ? record_history(body, step, damping) : read_ledger(body, step, damping);
    if (const auto stop = look_at_balance(ledger, body, step))
      return stop;
  }
  if (fields)
    record_fields(body, step);
  if (progress)
    progress_.print(progress_state(body, step, read_ledger(body, step, damping)));
  return {};
}

template <int dim>
std::optional<Stop> Recorder<dim>::look_at_balance(const EnergyLedger &ledger,
                                                   const CoupledBody<dim> &body,
                                                   const coupling::StepTime &step)
{
  extremes_.see(ledger);
  if (const auto finding =
          find_broken_balance(ledger, std::max(0., extremes_.most_work.value_or(0)), body))
    return stop_by_guard(*finding, step);
  return {};
}

template <int dim>
std::optional<Stop> Recorder<dim>::look_at_flow(const CoupledBody<dim> &body,
                                                const coupling::StepTime &step)
{
  const auto finding = guard_.look_at_flow(body);
  if (!finding)
    return {};
  if (finding->is_excess)
    return report_excess(finding->text, step);
  log_.warning(fmt::format("at {:.4g} s {}", step.time, finding->text));
  return {};
}

template <int dim>
bool Recorder<dim>::is_row_due(double time) const
{
  return time >= next_history_ - 1e-9 * history_interval_;
}

template <int dim>
bool Recorder<dim>::rows_are_apart(long far_steps, double far_step) const
{
  return history_interval_ > double(far_steps) * far_step;
}

template <int dim>
bool Recorder<dim>::breaks_between_rows(const CoupledBody<dim> &body,
                                        const coupling::StepTime &step) const
{
  const int ratio = body.coupler->step_ratio();
  return scene_.output.history_interval == 0 && step.step % (ratio * break_interval) == 0 &&
         rows_are_apart(break_interval, ratio * step.dt) && n_broken(body) > broken_in_rows_;
}

template <int dim>
EnergyLedger Recorder<dim>::record_history(const CoupledBody<dim> &body,
                                           const coupling::StepTime &step, double damping,
                                           bool is_last)
{
  if (in_static_phase_ || is_row_due(step.time))
    next_history_ = next_output(scene_, next_history_, history_interval_, step.time);
  broken_in_rows_ = n_broken(body);
  const Reading r = machine_.read(body, step.time);
  const EnergyLedger ledger = read_ledger(body, step, damping);
  const HistoryRow row = {r, ledger, n_broken(body), crack_length(body), in_static_phase_};
  curve_.add(step.time, r, n_broken(body));
  quasi_static_ = ledger.kinetic() < 0.01 * ledger.potential();
  if (quasi_static_ && keeps_copies(body))
    keep_copies(body, step.time, r.load);
  // Behind all else: a disk may refuse it, when ranks have told each other all.
  history_.add(body, step, row, is_last);
  return ledger;
}

// A crack that runs moves within microseconds, while the grips still feel a rising load: the states
// before it are the ones to show and to compare. Where nothing has broken yet, waves are, too.
template <int dim>
bool Recorder<dim>::keeps_copies(const CoupledBody<dim> &body) const
{
  return !curve_.has_ended() && (quasi_static_ || n_broken(body) == 0);
}

// Which fields are the last before fracture is known only later: they are copied on the way up.
template <int dim>
void Recorder<dim>::keep_copies(const CoupledBody<dim> &body, double time, double load)
{
  if (std::abs(load) <= copied_growth * std::abs(fields_copied_at_))
    return;
  fields_copied_at_ = load;
  peak_state_ = present_state(body, time);
}

template <int dim>
void Recorder<dim>::record_fields(const CoupledBody<dim> &body, const coupling::StepTime &step)
{
  next_fields_ = next_output(scene_, next_fields_, scene_.output.field_interval, step.time);
  BodyState state = present_state(body, step.time);
  state.bonds = broken_bonds(body);
  state_fields_.complete(body, state);
  write_fields(body, std::move(state));
}

template <int dim>
Piece Recorder<dim>::piece(const CoupledBody<dim> &body) const
{
  return writes_pieces_ ? Piece{body.ranks.rank(), body.ranks.size()} : Piece{};
}

template <int dim>
void Recorder<dim>::write_fields(const CoupledBody<dim> &body, BodyState state)
{
  const Piece piece = this->piece(body);
  if (piece.of == 1)
    gather_at_first(body, state);
  if (piece.of > 1 || writes_)
    writer_.submit([this, piece, state = std::move(state)] { fields_.write(state, piece); });
}

template <int dim>
BodyState Recorder<dim>::present_state(const CoupledBody<dim> &body, double time) const
{
  BodyState state;
  state.time = time;
  state.particles = particle_fields(body);
  if (writes_) // all ranks have the mesh
    state.cells = cell_fields(body);
  state.tools = tool_outlines(body);
  return state;
}

template <int dim>
std::optional<Stop> Recorder<dim>::report_excess(const std::string &finding,
                                                 const coupling::StepTime &step)
{
  const std::string reason = report(finding, step);
  if (scene_.coupling.guard == Guard::stop)
    return Stop{true, reason};
  return {};
}

template <int dim>
Stop Recorder<dim>::stop_by_guard(const std::string &finding, const coupling::StepTime &step)
{
  return {true, report(finding, step)};
}

template <int dim>
std::string Recorder<dim>::report(const std::string &finding, const coupling::StepTime &step)
{
  const std::string reason = fmt::format("at {:.4g} s {}", step.time, finding);
  log_.warning(reason);
  if (!trusted_until_)
    trusted_until_ = step.time;
  curve_.end();
  return reason;
}

// A bridge of a few bonds or a fragment between the halves may still join the sides: the load says
// that they carry nothing. Where it says nothing itself, a traction, what is left of the section
// must do. Halves that are pulled apart and dragged through a damping don't lose their load: they
// are apart when a wave from the last bond has reached both sides.
template <int dim>
void Recorder<dim>::look_for_break(const CoupledBody<dim> &body, const coupling::StepTime &step)
{
  if (!machine_.has_load()) // nor sides between which something is carried
    return;
  const auto left = path_.lost(body);
  if (!left)
    return;
  const auto bonds = body.force()->broken_bonds_of_body(body.zone->state);
  const int axis = machine_.axis();
  if (machine_.is_answer() && !curve_.has_fallen()) {
    const bool pulled = machine_.component() == axis && curve_.largest_load() > 0;
    const double place = bonds.back().position[axis];
    const double way = std::max(body.upper[axis] - place, place - body.lower[axis]);
    const double felt_at = bonds.back().time + way / body.force()->elastic_constants().wave_speed_p;
    if (*left > 0 || !pulled || step.time < felt_at)
      return;
  }
  broken_time_ = bonds.back().time;
  // Between two rows of a coarse history all of it may have happened.
  curve_.add(step.time, machine_.read(body, step.time), n_broken(body));
  curve_.end();
  break_state_ = present_state(body, step.time);
  log_.info("the load path is gone since {:.4g} s: {:.2g} of the section is left", *broken_time_,
            *left);
}

// What a run warned about, in its log and by what it booked.
template <int dim>
void Recorder<dim>::add_warnings(const CoupledBody<dim> &body, RunRecord &record) const
{
  if (guard_.n_broken() > 0)
    record.warnings.push_back(
        {fmt::format("{} of {} broken faces lie in the overlap", grouped(guard_.n_broken()),
                     grouped(record.broken_bonds)),
         guard_.energy()});
  if (std::abs(body.regime_change) > largest_regime_change * record.external_work.value_or(0))
    record.warnings.push_back(
        {"the change of regime took energy that no load had put in", body.regime_change});
  for (std::size_t k = 0; k < scene_.gauges.size() && body.force(); ++k)
    if (const GaugeParameters &g = scene_.gauges[k]; g.kind == GaugeKind::j_integral)
      if (const double time =
              broken_between<dim>(g, body.force()->broken_bonds_of_body(body.zone->state));
          std::isfinite(time))
        record.warnings.push_back(
            {fmt::format("faces broke between the rectangles of /gauges/{} from {:.4g} s on: its J "
                         "is not that of the tip alone any more",
                         k, time)});
  // Bond by bond there are no waves: settling takes all that breaking leaves.
  if (scene_.time.loading != Loading::sequential &&
      std::abs(body.settled) > largest_settled * record.external_work.value_or(0))
    record.warnings.push_back({body.settled > 0
                                   ? "settling into equilibria took energy that was still in "
                                     "waves: /damping or absorbing sides take it as it comes"
                                   : "the body is given the motion of its loads after equilibria, "
                                     "which is not slow beside what it stores: give slower loads",
                               body.settled});
}

template <int dim>
ProgressState Recorder<dim>::progress_state(const CoupledBody<dim> &body,
                                            const coupling::StepTime &step,
                                            const EnergyLedger &ledger) const
{
  ProgressState state;
  state.step = step.step;
  state.n_steps = n_steps_;
  state.first_step = first_step_;
  state.time = step.time;
  state.kinetic = ledger.kinetic();
  state.potential = ledger.potential();
  state.external_work = ledger.external_work;
  state.residual = ledger.residual();
  state.broken_bonds = n_broken(body);
  state.crack_length = crack_length(body);
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
void Recorder<dim>::keep_states(const CoupledBody<dim> &body, std::vector<BodyState> kept,
                                RunRecord &record, std::optional<PictureTime> pictures_until)
{
  if (!draws_pictures_)
    return;
  const auto bonds = broken_bonds(body);
  std::vector<const BodyState *> all;
  // Shared with the writer, which may be at work when memory ends here.
  const auto states = std::make_shared<std::vector<BodyState>>(std::move(kept));
  for (BodyState &state : *states) {
    const auto later = std::find_if(bonds.begin(), bonds.end(),
                                    [&](const BrokenBond &b) { return b.time > state.time; });
    state.bonds.assign(bonds.begin(), later);
    state_fields_.complete(body, state);
    const StateFiles files = FieldSeries::files(state, state.name, piece(body));
    record.states.push_back(
        {state.name, state.caption, state.time, files.particles, files.cells, state.tools});
    if (piece(body).of > 1)
      attempt([&] { writer_.submit([this, state, p = piece(body)] { fields_.write(state, p); }); });
    gather_at_first(body, state);
    all.push_back(&state);
  }
  if (piece(body).of == 1 && writes_)
    attempt([&] {
      writer_.submit([this, states] {
        for (const BodyState &state : *states)
          fields_.write(state);
      });
    });
  if (!writes_)
    return;
  record.magnification =
      scene_.output.magnification > 0 ? scene_.output.magnification : good_magnification(all);
  std::vector<std::string> missing;
  record.pictures = write_pictures(folder_, all, shown_fields(), dim, record.magnification,
                                   &missing, pictures_until);
  for (const std::string &reason : missing)
    log_.warning("a picture is missing: {}", reason);
  attempt([&] { writer_.wait(); });
}

template <int dim>
template <typename Write>
void Recorder<dim>::attempt(Write &&write)
{
  try {
    write();
  } catch (const core::EnvironmentError &error) {
    log_.warning("{}", error.what());
    if (failure_.empty())
      failure_ = error.what();
  }
}

template <int dim>
void Recorder<dim>::finish(const CoupledBody<dim> &body, const coupling::StepTime &step,
                           double damping, RunRecord &record,
                           std::optional<PictureTime> pictures_until)
{
  const auto timing = timers_.scope(section_);
  if (const auto finding = guard_.look(body, step.time))
    report(*finding, step);
  if (can_look_)
    if (const auto finding = guard_.look_at_flow(body); finding && finding->is_excess)
      report(finding->text, step);
  attempt([&] {
    if (can_look_)
      extremes_.see(record_history(body, step, damping, true));
    history_.flush();
  });
  progress_.finish(
      progress_state(body, step, can_look_ ? read_ledger(body, step, damping) : EnergyLedger()));
  const auto bonds = broken_bonds(body);
  attempt([&] { write_bonds(folder_.broken_bonds(), bonds); });
  if (!body.cut_faces.empty())
    attempt([&] { write_bonds(folder_.cut_faces(), body.cut_faces); });
  attempt([&] { snapshots_.write(body, folder_); });
  attempt([&] { history_.gauges().write(body, folder_); });
  record.gauges = history_.gauges().entries();

  curve_.put_into(record);
  std::vector<BodyState> states;
  const auto keep = [&](BodyState state, const char *name, const char *caption) {
    state.name = name;
    state.caption = caption;
    states.push_back(std::move(state));
  };
  if (fields_copied_at_ != 0)
    keep(std::move(peak_state_), "peak",
         record.peak_load ? "near the peak load" : "near the largest load");
  if (break_state_)
    keep(std::move(*break_state_), "broken", "when the load path is gone");
  if (can_look_)
    keep(present_state(body, step.time), "end", "at the end");
  if (!states.empty())
    keep_states(body, std::move(states), record, pictures_until);
  record.broken_time = broken_time_;
  record.trusted_until = trusted_until_;
  record.broken_bonds = n_broken(body);
  record.broken_in_overlap = guard_.n_broken();
  record.crack_length = crack_length(body);
  record.external_work = extremes_.most_work;
  record.energy_residual = extremes_.relative_residual();
  add_warnings(body, record);
  attempt([&] { writer_.wait(); });
  if (body.ranks.any(!failure_.empty()) && failure_.empty())
    failure_ = "another rank could not write its part of the fields";
}

template <int dim>
void Recorder<dim>::write_bonds(const std::string &path, const std::vector<BrokenBond> &bonds) const
{
  if (writes_)
    write_broken_bonds(path, bonds, dim);
}

template double output_seconds(const Scene &, const CoupledBody<2> &, long);
template double output_seconds(const Scene &, const CoupledBody<3> &, long);
template class Recorder<2>;
template class Recorder<3>;
} // namespace ligament::program
