#include "src/simulation/static_phases.h"

#include "core/check.h"
#include "src/simulation/energy_ledger.h"
#include "src/simulation/kept_tables.h"
#include "src/simulation/load_growth.h"
#include "src/simulation/test_machine.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace ligament::program
{
namespace
{
using Seconds = std::chrono::duration<double>;

enum class PhaseEnd
{
  bond_breaks,
  above_strength,
  end_of_run,
  out_of_balance,
  no_resistance,
  stopped,
  calm,
  restless
};

std::string text_of(PhaseEnd end)
{
  switch (end) {
  case PhaseEnd::bond_breaks:
    return "a bond bears its strength";
  case PhaseEnd::above_strength:
    return "a bond bears more than its strength in equilibrium";
  case PhaseEnd::end_of_run:
    return "end of the run";
  case PhaseEnd::out_of_balance:
    return "no equilibrium was found";
  case PhaseEnd::no_resistance:
    return "the body no longer carries";
  case PhaseEnd::stopped:
    return "the run was stopped";
  case PhaseEnd::calm:
    return "the body is calm";
  case PhaseEnd::restless:
    return "nothing broke for 50 transits";
  }
  return {};
}

struct Phase
{
  bool is_static;
  long begin, end; // steps
  int solves = 0, iterations = 0;
  double load = 0; // N
  long broken = 0;
  PhaseEnd reason = PhaseEnd::end_of_run;
  double seconds = 0;
};

constexpr double quiet_share = 0.01; // of the potential energy
constexpr double most_transits = 50;
constexpr int looks_per_transit = 4;

template <int dim>
double largest_extent(const CoupledBody<dim> &body)
{
  double largest = 0;
  for (int c = 0; c < dim; ++c)
    if (body.zone) {
      const auto &x = body.zone->state.reference[c];
      const auto [least, most] = std::minmax_element(x.begin(), x.end());
      largest = std::max(largest, *most - *least);
    } else
      largest = std::max(largest, body.upper[c] - body.lower[c]);
  return largest;
}

template <int dim>
double shear_wave_speed(const CoupledBody<dim> &body)
{
  if (body.force())
    return body.force()->elastic_constants().wave_speed_s;
  const auto &solid = body.far->body();
  return std::sqrt(solid.stiffness(n_strains<dim> - 1, n_strains<dim> - 1) / solid.density);
}

template <int dim>
long n_broken(const CoupledBody<dim> &body)
{
  return body.force() ? long(body.force()->broken_bonds().size()) : 0;
}
} // namespace

template <int dim>
struct StaticPhases<dim>::Work
{
  using End = typename EquilibriumSolver<dim>::End;
  using Place = typename StaticSystem<dim>::Place;

  Work(const Scene &scene, CoupledBody<dim> &body, core::Log &log)
      : loading(scene.time.loading), calm(scene.time.calm), log(log), machine(body),
        solver(body, preconditioning(scene.time.static_solver)),
        transit(largest_extent(body) / shear_wave_speed(body)), ratio(body.coupler->step_ratio())
  {
  }

  bool is_calm(const CoupledBody<dim> &body, const Clock &clock);
  void end_dynamic_phase(const CoupledBody<dim> &body, const Clock &clock);
  std::optional<Stop> advance_once(CoupledBody<dim> &body, Clock &clock, double damping,
                                   const Look &look);

  /// The part of a static phase between two corners of the loads' ramps: from `start`, where the
  /// body is in equilibrium, along the response of the body to the step `end` and a little off it.
  struct Stretch
  {
    LoadGrowth<dim> growth;
    Place start, finish;
    Eigen::VectorXd response, bend;
    long begin, end;     // steps
    double share = 0;    // of the growth, at its end
    bool breaks = false; // a bond, there
  };
  /// At most to the step `reach`.
  Stretch stretch_from(const CoupledBody<dim> &body, const Clock &clock, long reach) const;
  /// Sets its end also where it fails: the step in which no equilibrium was found.
  End find_end(CoupledBody<dim> &body, const Clock &clock, Stretch &stretch);
  std::optional<double> share_that_breaks(CoupledBody<dim> &body, const Clock &clock,
                                          Stretch &stretch, double &slope);
  std::optional<Stop> walk(CoupledBody<dim> &body, Clock &clock, const Stretch &stretch,
                           const Look &look);
  void commit(CoupledBody<dim> &body, const Clock &clock, const Eigen::VectorXd &velocities);

  double load_of(const CoupledBody<dim> &body, const Clock &clock) const
  {
    return machine.has_load() ? machine.read(body, clock.now.time).load : 0;
  }
  double time_of(const Clock &clock, long step) const { return double(step) * clock.now.dt; }
  /// The first step of the far field after `begin` by which the loads have grown that far.
  long step_of(const Clock &clock, const Stretch &stretch, double share, long last) const;
  double bond_share(double time, double noted)
  {
    solver.system().forces(time, noted);
    return body_share();
  }
  std::function<double()> body_share;

  Loading loading;
  double calm; // transits
  core::Log &log;
  TestMachine<dim> machine;
  EquilibriumSolver<dim> solver;
  double transit; // s
  int ratio;

  std::vector<Phase> phases; // complete ones
  long dynamic_since = -1;   // step; before the first phase: none
  std::chrono::steady_clock::time_point dynamic_began = std::chrono::steady_clock::now();
  bool is_restless = false;     // the last dynamic phase ended without being calm
  double stretching_energy = 0; // J, in the last commit
  long broken_then = 0;
};

template <int dim>
StaticPhases<dim>::StaticPhases(const Scene &scene, CoupledBody<dim> &body, core::Log &log)
{
  if (!scene.time.has_phases())
    return;
  work_ = std::make_unique<Work>(scene, body, log);
}

template <int dim>
StaticPhases<dim>::~StaticPhases() = default;
template <int dim>
StaticPhases<dim>::StaticPhases(StaticPhases &&) noexcept = default;
template <int dim>
StaticPhases<dim> &StaticPhases<dim>::operator=(StaticPhases &&) noexcept = default;

template <int dim>
bool StaticPhases<dim>::are_due(const CoupledBody<dim> &body, const Clock &clock)
{
  return work_ && !clock.is_at_end() && work_->is_calm(body, clock);
}

// Once every quarter of a transit, counted from the last phase: a run that goes on from a
// checkpoint looks in the same steps.
template <int dim>
bool StaticPhases<dim>::Work::is_calm(const CoupledBody<dim> &body, const Clock &clock)
{
  if (dynamic_since < 0 || loading == Loading::sequential)
    return true;
  const long far_steps = (clock.now.step - dynamic_since) / ratio;
  const long interval =
      std::max(1l, std::lround(transit / (looks_per_transit * ratio * clock.now.dt)));
  if (far_steps == 0 || far_steps % interval != 0)
    return false;
  double since = time_of(clock, dynamic_since);
  if (n_broken(body) > 0)
    since = std::max(since, body.force()->broken_bonds().back().time);
  const double transits = (clock.now.time - since) / transit;
  if (transits < calm)
    return false;
  is_restless = transits >= most_transits;
  if (is_restless)
    return true;
  const auto e = body.coupler->energy(body.bodies(), clock.now);
  return e.kinetic_discrete + e.kinetic_far <
         quiet_share * (e.potential_discrete + e.potential_far + e.blended);
}

template <int dim>
void StaticPhases<dim>::Work::end_dynamic_phase(const CoupledBody<dim> &body, const Clock &clock)
{
  if (dynamic_since < 0 || dynamic_since == clock.now.step)
    return;
  Phase phase{false, dynamic_since, clock.now.step};
  phase.load = load_of(body, clock);
  phase.broken = n_broken(body) - broken_then;
  phase.reason = is_restless ? PhaseEnd::restless : PhaseEnd::calm;
  phase.seconds = Seconds(std::chrono::steady_clock::now() - dynamic_began).count();
  phases.push_back(phase);
}

template <int dim>
std::optional<Stop> StaticPhases<dim>::advance(CoupledBody<dim> &body, Clock &clock, double damping,
                                               const Look &look)
{
  Work &work = *work_;
  while (true) {
    const auto stop = work.advance_once(body, clock, damping, look);
    const bool goes_on = work.loading == Loading::sequential && !stop && !clock.is_at_end() &&
                         work.phases.back().reason != PhaseEnd::out_of_balance &&
                         work.phases.back().reason != PhaseEnd::no_resistance;
    if (!goes_on)
      return stop;
    if (const auto end = look())
      return end;
    clock.advance(work.ratio); // bonds break once at a time
  }
}

// The energy that the body loses on its way to equilibrium is booked; the loads stand still.
template <int dim>
std::optional<Stop> StaticPhases<dim>::Work::advance_once(CoupledBody<dim> &body, Clock &clock,
                                                          double damping, const Look &look)
{
  const auto started = std::chrono::steady_clock::now();
  end_dynamic_phase(body, clock);
  Phase phase{true, clock.now.step, clock.now.step};
  const int solves = solver.n_solves(), iterations = solver.n_iterations();
  const long broken_before = n_broken(body);
  body_share = [&body] { return body.force() ? body.force()->trial_share(body.zone->state) : 0.; };
  std::optional<Stop> stop;
  const auto finish = [&](PhaseEnd reason) {
    phase.end = clock.now.step;
    phase.solves = solver.n_solves() - solves;
    phase.iterations = solver.n_iterations() - iterations;
    phase.load = load_of(body, clock);
    phase.broken = n_broken(body) - broken_before;
    phase.reason = reason;
    phase.seconds = Seconds(std::chrono::steady_clock::now() - started).count();
    phases.push_back(phase);
    dynamic_since = clock.now.step;
    dynamic_began = std::chrono::steady_clock::now();
    broken_then = n_broken(body);
    log.info("static phase to {:.6g} s: {} ({} solves, {} iterations, {} faces broken)",
             clock.now.time, text_of(reason), phase.solves, phase.iterations, phase.broken);
  };
  const auto failed = [&](End end) {
    log.warning("at {:.4g} s {}: the run goes on by steps", clock.now.time,
                end == End::indefinite ? "the body no longer carries its load"
                                       : "no equilibrium was found");
    finish(end == End::indefinite ? PhaseEnd::no_resistance : PhaseEnd::out_of_balance);
  };

  if (loading == Loading::sequential && body.force()) // a body built anew does not know
    body.force()->break_one_by_one();
  solver.renew();
  const double before = read_ledger(body, clock.now, damping).residual();
  const auto velocities = solver.system().velocities();
  Eigen::VectorXd moved;
  const End balanced = solver.find_equilibrium(clock.now.time, moved);
  if (balanced != End::converged) {
    solver.system().put_back(velocities);
    auto bodies = body.bodies();
    body.coupler->compute_forces(bodies, clock.now);
    failed(balanced);
    return stop;
  }
  // How far at once: less where no equilibrium was found so far away.
  long reach = clock.n_steps;
  int n_halvings = 0;
  constexpr int most_halvings = 5;
  for (bool is_first = true;; is_first = false) {
    Stretch stretch = stretch_from(body, clock, reach);
    End end = solver.find_response(clock.now.time, time_of(clock, stretch.end), stretch.response);
    stretch.start = solver.system().place();
    const auto stay = [&] {
      commit(body, clock,
             end == End::indefinite
                 ? Eigen::VectorXd::Zero(solver.system().size())
                 : Eigen::VectorXd(stretch.growth.rate(clock.now.time) * stretch.response));
    };
    if (is_first) {
      stay();
      body.settled += before - read_ledger(body, clock.now, damping).residual();
      if (n_broken(body) > broken_before) {
        finish(PhaseEnd::above_strength);
        return stop;
      }
      if ((stop = look())) {
        finish(PhaseEnd::stopped);
        return stop;
      }
    }
    if (end == End::converged)
      end = find_end(body, clock, stretch);
    if (end == End::stalled && n_halvings < most_halvings &&
        stretch.end - stretch.begin >= 4 * ratio) {
      ++n_halvings;
      solver.system().put_back(stretch.start);
      reach = stretch.begin + (stretch.end - stretch.begin) / (2 * ratio) * ratio;
      continue;
    }
    if (end != End::converged) {
      solver.system().put_back(stretch.start);
      stay();
      failed(end);
      return stop;
    }
    if ((stop = walk(body, clock, stretch, look))) {
      finish(PhaseEnd::stopped);
      return stop;
    }
    if (n_broken(body) > broken_before) {
      finish(PhaseEnd::bond_breaks);
      return stop;
    }
    if (clock.is_at_end()) {
      finish(PhaseEnd::end_of_run);
      return stop;
    }
    if ((stop = look())) {
      finish(PhaseEnd::stopped);
      return stop;
    }
    n_halvings = 0;
    reach = std::min(clock.n_steps, stretch.end + 4 * (stretch.end - stretch.begin));
  }
}

// Loads that don't grow in proportion almost do so over short stretches within their ramps.
template <int dim>
typename StaticPhases<dim>::Work::Stretch
StaticPhases<dim>::Work::stretch_from(const CoupledBody<dim> &body, const Clock &clock,
                                      long reach) const
{
  const double now = clock.now.time;
  const auto growth_to = [&](long step) {
    return LoadGrowth<dim>(body.loads, now, time_of(clock, step));
  };
  Stretch stretch{growth_to(reach), {}, {}, {}, {}, clock.now.step, reach};
  if (stretch.growth.is_proportional())
    return stretch;
  const double corner = LoadGrowth<dim>::next_corner(body.loads, now, time_of(clock, reach));
  stretch.end =
      std::clamp(clock.now.step +
                     ratio * long(std::ceil((corner - now) / (ratio * clock.now.dt) * (1 - 1e-12))),
                 clock.now.step + ratio, reach);
  constexpr int parts = 4;
  const long far_steps = (stretch.end - stretch.begin) / ratio;
  if (!growth_to(stretch.end).is_proportional() && far_steps >= parts)
    stretch.end = stretch.begin + far_steps / parts * ratio;
  stretch.growth = growth_to(stretch.end);
  return stretch;
}

template <int dim>
long StaticPhases<dim>::Work::step_of(const Clock &clock, const Stretch &stretch, double share,
                                      long last) const
{
  long low = 0, high = (last - stretch.begin) / ratio;
  while (high - low > 1) {
    const long middle = low + (high - low) / 2;
    (stretch.growth.share(time_of(clock, stretch.begin + middle * ratio)) >= share * (1 - 1e-14)
         ? high
         : low) = middle;
  }
  return stretch.begin + high * ratio;
}

// Where the first bond bears its strength along the response: the largest share of the strength is
// convex in the share of the growth. Empty where none does.
template <int dim>
std::optional<double> StaticPhases<dim>::Work::share_that_breaks(CoupledBody<dim> &body,
                                                                 const Clock &clock,
                                                                 Stretch &stretch, double &slope)
{
  if (!body.force() || !body.force()->can_break())
    return {};
  double at = 0; // the body is there
  auto &system = solver.system();
  const auto bears = [&](double share, double noted) {
    system.displace(stretch.response, share - at);
    at = share;
    return bond_share(time_of(clock, step_of(clock, stretch, share, stretch.end)), noted);
  };
  constexpr double least = 0.5, near = 0.9, exact = 2e-6;
  const double full = stretch.growth.share(time_of(clock, stretch.end));
  double low = 0, at_low = 0, high = full, at_high = bears(full, least);
  std::optional<double> found;
  if (at_high >= 1) {
    // From rest the share is proportional to the load.
    double next = full / at_high;
    for (int look = 0; look < 40; ++look) {
      const double share = bears(next, at_low < near ? least : near);
      slope = at_high > share && high > next ? (at_high - share) / (high - next) : slope;
      if (share >= 1) {
        high = next;
        at_high = share;
      } else {
        low = next;
        at_low = std::max(share, least);
      }
      if (std::abs(share - 1) < exact || high - low < 1e-12 * full) {
        found = next;
        break;
      }
      next = low + (1 - at_low) / (at_high - at_low) * (high - low);
      if (look % 4 == 3) // one end may stay for long
        next = (low + high) / 2;
    }
    if (!found)
      found = high;
  }
  system.put_back(stretch.start);
  return found;
}

// Equilibrium at the end of the stretch, moved to the first step in which a bond bears its strength
// or more.
template <int dim>
typename EquilibriumSolver<dim>::End
StaticPhases<dim>::Work::find_end(CoupledBody<dim> &body, const Clock &clock, Stretch &stretch)
{
  auto &system = solver.system();
  double slope = 0;
  const auto predicted = share_that_breaks(body, clock, stretch, slope);
  long step = predicted ? step_of(clock, stretch, *predicted, stretch.end) : stretch.end;
  stretch.bend = Eigen::VectorXd::Zero(system.size());
  double at = 0, bore = 0; // share of the growth, of the strength
  constexpr int most_corrections = 8;
  // Where loads grow by less in a step, its number is below what the strength says.
  constexpr double over = 1e-6; // of the strength
  for (int k = 0;; ++k) {
    const double share = stretch.growth.share(time_of(clock, step));
    system.displace(stretch.response, share - at);
    if (at > 0) { // along the parabola of walk()
      const double longer = share * share / (at * at);
      system.displace(stretch.bend, longer - 1);
      stretch.bend *= longer;
    }
    Eigen::VectorXd moved;
    const End end = solver.find_equilibrium(time_of(clock, step), moved);
    if (end != End::converged) {
      stretch.end = step;
      return end;
    }
    stretch.bend += moved;
    const double bears =
        body.force() && body.force()->can_break() ? bond_share(time_of(clock, step), 0.5) : 0;
    if (k > 0 && share != at && (bears - bore) * (share - at) > 0)
      slope = (bears - bore) / (share - at);
    if (slope == 0 && share > 0)
      slope = bears / share;
    at = share;
    bore = bears;
    const double one_step =
        share - stretch.growth.share(time_of(clock, std::max(stretch.begin, step - ratio)));
    const bool is_first =
        bears - std::max(slope * one_step, over) < 1 || step - ratio <= stretch.begin;
    const bool done = bears >= 1 ? is_first : step == stretch.end;
    if (done || k == most_corrections) {
      stretch.end = step;
      stretch.share = share;
      stretch.breaks = bears >= 1;
      stretch.finish = system.place();
      return end;
    }
    const double aim = slope * one_step < over ? 1 + over / 2 : 1;
    const long wanted = step_of(clock, stretch, share + (aim - bears) / slope, stretch.end);
    const long other = bears >= 1 ? std::min(wanted, step - ratio) : std::max(wanted, step + ratio);
    step = std::clamp(other, stretch.begin + ratio, stretch.end);
  }
}

// Along a parabola, on which forces stay in balance to the third order in the loads: they do the
// work that the ledger books.
template <int dim>
std::optional<Stop> StaticPhases<dim>::Work::walk(CoupledBody<dim> &body, Clock &clock,
                                                  const Stretch &stretch, const Look &look)
{
  auto &system = solver.system();
  system.put_back(stretch.start);
  const long broken_before = n_broken(body);
  constexpr double rows_of_whole = 50;
  const int n_rows = std::max(
      2, int(std::ceil(rows_of_whole * double(stretch.end - stretch.begin) / double(stretch.end))));
  double at = 0; // share of the growth
  const auto bent = [&](double share) {
    return stretch.share > 0 ? share * share / (stretch.share * stretch.share) : 0;
  };
  for (int row = 1; row <= n_rows; ++row) {
    const long step = row == n_rows
                          ? stretch.end
                          : step_of(clock, stretch, stretch.share * row / n_rows, stretch.end);
    if (step <= clock.now.step)
      continue;
    clock.advance(step - clock.now.step);
    const double share = stretch.growth.share(clock.now.time);
    if (step == stretch.end)
      system.put_back(stretch.finish);
    else
      system.displace(Eigen::VectorXd((share - at) * stretch.response +
                                      (bent(share) - bent(at)) * stretch.bend));
    at = share;
    commit(body, clock, stretch.growth.rate(clock.now.time) * stretch.response);
    if (n_broken(body) > broken_before || step == stretch.end)
      return {};
    if (const auto stop = look())
      return stop;
  }
  return {};
}

// The body stretches at the rate of its loads. That it does so no step has seen: the loads' work is
// that of bodies without inertia, and the energy of this motion is booked beside it.
template <int dim>
void StaticPhases<dim>::Work::commit(CoupledBody<dim> &body, const Clock &clock,
                                     const Eigen::VectorXd &velocities)
{
  auto &system = solver.system();
  if (ratio > 1)
    system.forces(clock.now.time); // of the far field, which its impulses are made of
  system.set_velocities(velocities, clock.now);
  const double stretching = system.motion_energy(clock.now);
  body.settled -= stretching - stretching_energy;
  stretching_energy = stretching;
  if (body.force())
    body.force()->resume_at(clock.now.time - clock.now.dt);
  auto bodies = body.bodies();
  body.coupler->compute_forces(bodies, clock.now);
}

template <int dim>
std::vector<PhaseEntry> StaticPhases<dim>::entries(const CoupledBody<dim> &body,
                                                   const Clock &clock) const
{
  std::vector<PhaseEntry> entries;
  if (!work_)
    return entries;
  std::vector<Phase> phases = work_->phases;
  if (work_->dynamic_since >= 0 && clock.now.step > work_->dynamic_since) {
    Phase phase{false, work_->dynamic_since, clock.now.step};
    phase.load = work_->load_of(body, clock);
    phase.broken = n_broken(body) - work_->broken_then;
    phase.seconds = Seconds(std::chrono::steady_clock::now() - work_->dynamic_began).count();
    phases.push_back(phase);
  }
  for (const Phase &p : phases) {
    PhaseEntry e;
    e.kind = p.is_static ? "static" : "dynamic";
    e.begin = work_->time_of(clock, p.begin);
    e.end = work_->time_of(clock, p.end);
    (p.is_static ? e.steps_skipped : e.steps) = p.end - p.begin;
    e.solves = p.solves;
    e.iterations = p.iterations;
    e.load = p.load;
    e.broken = p.broken;
    e.reason = text_of(p.reason);
    e.seconds = p.seconds;
    entries.push_back(e);
  }
  return entries;
}

template <int dim>
void StaticPhases<dim>::save(core::State &state) const
{
  if (!work_)
    return;
  core::save_value(state, "static_phases", "dynamic_since", std::int64_t(work_->dynamic_since));
  core::save_value(state, "static_phases", "broken_then", std::int64_t(work_->broken_then));
  core::save_value(state, "static_phases", "largest_load", work_->solver.largest_load());
  core::save_value(state, "static_phases", "stretching_energy", work_->stretching_energy);
  // Found again, in a body in which bonds have broken, they would differ by round-off.
  const auto free = work_->solver.free_shares();
  core::save_value(state, "static_phases", "free_motions", std::int64_t(free.n));
  core::Table shares = numbered_rows(free.shares.size());
  shares.add("share", free.shares);
  state["free_motions"] = std::move(shares);
  core::Table rows = numbered_rows(work_->phases.size());
  const auto add = [&](const char *name, auto &&value) {
    std::vector<std::decay_t<decltype(value(work_->phases[0]))>> column;
    for (const Phase &p : work_->phases)
      column.push_back(value(p));
    rows.add(name, column);
  };
  const auto whole = [](auto value) { return std::int64_t(value); };
  add("is_static", [&](const Phase &p) { return whole(p.is_static); });
  add("begin", [&](const Phase &p) { return whole(p.begin); });
  add("end", [&](const Phase &p) { return whole(p.end); });
  add("solves", [&](const Phase &p) { return whole(p.solves); });
  add("iterations", [&](const Phase &p) { return whole(p.iterations); });
  add("broken", [&](const Phase &p) { return whole(p.broken); });
  add("reason", [&](const Phase &p) { return whole(p.reason); });
  add("load", [](const Phase &p) { return p.load; });
  add("seconds", [](const Phase &p) { return p.seconds; });
  state["phases"] = std::move(rows);
}

template <int dim>
void StaticPhases<dim>::load(const core::State &state)
{
  if (!work_)
    return;
  work_->dynamic_since = long(core::load_integer(state, "static_phases", "dynamic_since"));
  work_->broken_then = long(core::load_integer(state, "static_phases", "broken_then"));
  work_->solver.set_largest_load(core::load_real(state, "static_phases", "largest_load"));
  work_->stretching_energy = core::load_real(state, "static_phases", "stretching_energy");
  work_->solver.set_free_shares({int(core::load_integer(state, "static_phases", "free_motions")),
                                 core::table(state, "free_motions").reals("share")});
  const core::Table &rows = core::table(state, "phases");
  const auto numbers = [&](const char *name) { return rows.integers(name); };
  const auto is_static = numbers("is_static"), begin = numbers("begin"), end = numbers("end"),
             solves = numbers("solves"), iterations = numbers("iterations"),
             broken = numbers("broken"), reason = numbers("reason");
  const auto load = rows.reals("load"), seconds = rows.reals("seconds");
  work_->phases.clear();
  for (std::size_t k = 0; k < rows.n_rows(); ++k)
    work_->phases.push_back({is_static[k] != 0, long(begin[k]), long(end[k]), int(solves[k]),
                             int(iterations[k]), load[k], long(broken[k]), PhaseEnd(reason[k]),
                             seconds[k]});
}

template class StaticPhases<2>;
template class StaticPhases<3>;
} // namespace ligament::program
