#include "src/simulation/static_phases.h"

#include "core/check.h"
#include "src/simulation/energy_ledger.h"
#include "src/simulation/kept_tables.h"
#include "src/simulation/phase_list.h"
#include "src/simulation/test_machine.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace ligament::program
{
namespace
{
using Seconds = std::chrono::duration<double>;

constexpr double quiet_share = 0.01; // of the potential energy
constexpr double most_transits = 50;
constexpr int looks_per_transit = 4;

template <int dim>
double largest_extent(const CoupledBody<dim> &body)
{
  double largest = 0;
  for (int c = 0; c < dim; ++c) {
    if (!body.zone) {
      largest = std::max(largest, body.upper[c] - body.lower[c]);
      continue;
    }
    const auto &x = body.zone->state.reference[c];
    std::vector<double> ends;
    if (!x.empty()) {
      const auto [least, most] = std::minmax_element(x.begin(), x.end());
      ends = {*least, *most};
    }
    ends = body.ranks.gather_all(ends);
    const auto [first, last] = std::minmax_element(ends.begin(), ends.end());
    largest = std::max(largest, *last - *first);
  }
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
  return body.force() ? long(body.force()->n_broken()) : 0;
}

double potential_of(const coupling::CoupledEnergy &e)
{
  return e.potential_discrete + e.potential_far + e.blended;
}

/// In s, of the bonds that have broken so far.
template <int dim>
double last_break(const CoupledBody<dim> &body)
{
  const auto &broken = body.force()->broken_bonds();
  std::vector<double> times;
  if (!broken.empty())
    times.push_back(broken.back().time);
  times = body.ranks.gather_all(times);
  return *std::max_element(times.begin(), times.end());
}
} // namespace

template <int dim>
struct StaticPhases<dim>::Work
{
  Work(const Scene &scene, CoupledBody<dim> &body, core::Log &log, const core::Ranks &helpers)
      : loading(scene.time.loading), calm(scene.time.calm), log(log), machine(body),
        transit(largest_extent(body) / shear_wave_speed(body)), ratio(body.coupler->step_ratio())
  {
    if (body.ranks.is_one())
      solver.emplace(body, preconditioning(scene.time.static_solver), helpers);
  }

  bool looks(const Clock &clock) const;
  bool is_calm(const CoupledBody<dim> &body, const Clock &clock);
  int n_failures() const;
  bool has_been_restless() const
  {
    return std::any_of(phases.begin(), phases.end(),
                       [](const Phase &p) { return p.reason == PhaseEnd::restless; });
  }
  void end_dynamic_phase(const CoupledBody<dim> &body, const Clock &clock);
  std::optional<Stop> advance(CoupledBody<dim> &body, Clock &clock, double damping,
                              const Look &look);

  double load_of(const CoupledBody<dim> &body, const Clock &clock) const
  {
    return machine.has_load() ? machine.read(body, clock.now.time).load : 0;
  }
  double time_of(const Clock &clock, long step) const { return double(step) * clock.now.dt; }

  Loading loading;
  double calm; // transits
  core::Log &log;
  TestMachine<dim> machine;
  std::optional<EquilibriumSolver<dim>> solver; // of a whole body
  double largest_load = 0;                      // that it last knew of, N
  typename EquilibriumSolver<dim>::FreeShares free_shares{};
  double transit; // s
  int ratio;

  std::vector<Phase> phases; // complete ones
  long dynamic_since = -1;   // step; before the first phase: none
  double dynamic_before = 0; // s of a dynamic phase in other processes, or with other bodies
  std::chrono::steady_clock::time_point dynamic_began = std::chrono::steady_clock::now();
  double dynamic_seconds() const
  {
    return dynamic_before + Seconds(std::chrono::steady_clock::now() - dynamic_began).count();
  }
  bool is_restless = false;     // the last dynamic phase ended without being calm
  bool goes_on = false;         // with another static phase
  int skipped = 0;              // steps, between two static phases
  double residual = 0;          // of the ledger between them, J
  double stretching_energy = 0; // J, in the last commit
  Borne borne;
  long broken_then = 0;
  double held_energy = 0; // J, at the end of the last static phase
};

template <int dim>
StaticPhases<dim>::StaticPhases(const Scene &scene, CoupledBody<dim> &body, core::Log &log,
                                const core::Ranks &helpers)
{
  if (!scene.time.has_phases())
    return;
  work_ = std::make_unique<Work>(scene, body, log, helpers);
}

template <int dim>
StaticPhases<dim>::~StaticPhases() = default;
template <int dim>
StaticPhases<dim>::StaticPhases(StaticPhases &&) noexcept = default;
template <int dim>
StaticPhases<dim> &StaticPhases<dim>::operator=(StaticPhases &&) noexcept = default;

template <int dim>
bool StaticPhases<dim>::look_at(const Clock &clock) const
{
  return work_ && !clock.is_at_end() && (work_->goes_on || work_->looks(clock));
}

template <int dim>
bool StaticPhases<dim>::are_due(const CoupledBody<dim> &body, const Clock &clock)
{
  return work_ && !clock.is_at_end() && (work_->goes_on || work_->is_calm(body, clock));
}

// Static phases of late that found no equilibrium: the next one has to wait for longer.
template <int dim>
int StaticPhases<dim>::Work::n_failures() const
{
  int n = 0;
  for (auto phase = phases.rbegin(); phase != phases.rend(); ++phase) {
    if (!phase->is_static)
      continue;
    if (phase->reason != PhaseEnd::out_of_balance && phase->reason != PhaseEnd::no_resistance)
      break;
    ++n;
  }
  return n;
}

// Once every quarter of a transit, counted from the last phase: a run that goes on from a
// checkpoint looks in the same steps.
template <int dim>
bool StaticPhases<dim>::Work::looks(const Clock &clock) const
{
  if (dynamic_since < 0 || (loading == Loading::sequential && n_failures() == 0))
    return true;
  const long far_steps = (clock.now.step - dynamic_since) / ratio;
  const long interval =
      std::max(1l, std::lround(transit / (looks_per_transit * ratio * clock.now.dt)));
  return far_steps > 0 && far_steps % interval == 0;
}

template <int dim>
bool StaticPhases<dim>::Work::is_calm(const CoupledBody<dim> &body, const Clock &clock)
{
  if (dynamic_since < 0 || (loading == Loading::sequential && n_failures() == 0))
    return true;
  if (!looks(clock))
    return false;
  double since = time_of(clock, dynamic_since);
  if (n_broken(body) > 0)
    since = std::max(since, last_break(body));
  if (body.force())
    since = std::max(since, body.force()->last_softening());
  const double transits = (clock.now.time - since) / transit;
  if (transits < calm * std::exp2(std::min(n_failures(), 6)))
    return false;
  is_restless = transits >= most_transits;
  if (is_restless)
    return true;
  const auto e = body.coupler->energy(body.bodies(), clock.now);
  const double kinetic = e.kinetic_discrete + e.kinetic_far, potential = potential_of(e);
  // What has fallen apart holds nothing, and its pieces go on with their grips: where the body
  // stretched evenly they have three times the energy of that motion.
  constexpr double of_pieces = 4;
  return kinetic < quiet_share * potential ||
         std::max(kinetic - of_pieces * stretching_energy, potential) < quiet_share * held_energy;
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
  if (is_restless && !has_been_restless())
    log.warning(
        "at {:.4g} s waves have not left the body in {:g} transits of a shear wave: what "
        "still moves is taken out of it and booked as settled; give \"local\" or \"mass\" in "
        "/damping, or let sides absorb",
        clock.now.time, most_transits);
  phase.seconds = dynamic_seconds();
  phases.push_back(phase);
}

template <int dim>
std::optional<Stop> StaticPhases<dim>::advance(CoupledBody<dim> &body, Clock &clock, double damping,
                                               const Look &look)
{
  Work &work = *work_;
  const auto stop = work.advance(body, clock, damping, look);
  const PhaseEnd reason = work.phases.back().reason;
  // The last step of all is one of the loop, which ends the run.
  work.goes_on = (work.loading == Loading::sequential || reason == PhaseEnd::face_torn) && !stop &&
                 clock.now.step + work.ratio < clock.n_steps &&
                 reason != PhaseEnd::out_of_balance && reason != PhaseEnd::no_resistance;
  return stop;
}

template <int dim>
Borne StaticPhases<dim>::borne() const
{
  return work_ ? work_->borne : Borne();
}

template <int dim>
bool StaticPhases<dim>::goes_on() const
{
  return work_ && work_->goes_on;
}

template <int dim>
void StaticPhases<dim>::pass_step(const CoupledBody<dim> &body, Clock &clock, double damping)
{
  clock.advance(work_->ratio);
  work_->skipped = work_->ratio;
  work_->dynamic_since = clock.now.step;
  work_->residual = read_ledger(body, clock.now, damping).residual();
}

template <int dim>
std::optional<Stop> StaticPhases<dim>::Work::advance(CoupledBody<dim> &body, Clock &clock,
                                                     double damping, const Look &look)
{
  const auto started = std::chrono::steady_clock::now();
  end_dynamic_phase(body, clock);
  Phase phase{true, clock.now.step - std::exchange(skipped, 0), clock.now.step};
  const int solves = solver->n_solves(), iterations = solver->n_iterations();
  const long broken_before = n_broken(body);
  if (loading == Loading::sequential && body.force()) // a body built anew does not know
    body.force()->break_one_by_one();

  StaticWalk<dim> walk(body, *solver, clock, machine, damping, look, stretching_energy);
  // A body that goes on from here in another process has no forces yet.
  phase.reason = walk.run(goes_on ? std::optional(residual) : std::nullopt);
  borne = walk.borne();
  if (phase.reason == PhaseEnd::no_resistance || phase.reason == PhaseEnd::out_of_balance)
    log.warning("at {:.4g} s {}: the run goes on by steps", clock.now.time,
                phase.reason == PhaseEnd::no_resistance ? "the body no longer carries its load"
                                                        : "no equilibrium was found");

  const bool is_first =
      std::none_of(phases.begin(), phases.end(), [](const Phase &p) { return p.is_static; });
  constexpr double least_unresisted = 1e-3; // what pieces of sides of unlike cells may leave
  if (is_first && solver->unresisted_share() > least_unresisted)
    log.warning(
        "nothing resists {:.2g} of the load, which moves the body as a whole: static phases "
        "leave this motion out; hold a side, or give loads that are in balance",
        solver->unresisted_share());

  phase.end = clock.now.step;
  phase.solves = solver->n_solves() - solves;
  phase.iterations = solver->n_iterations() - iterations;
  phase.load = load_of(body, clock);
  phase.broken = n_broken(body) - broken_before;
  phase.seconds = Seconds(std::chrono::steady_clock::now() - started).count();
  dynamic_since = clock.now.step;
  dynamic_before = 0;
  dynamic_began = std::chrono::steady_clock::now();
  broken_then = n_broken(body);
  held_energy = potential_of(body.coupler->energy(body.bodies(), clock.now));
  const std::string by = phase.solves > 0 ? std::string(" by ") + solver->preconditioner() : "";
  log.info("static phase to {:.6g} s: {} ({} solves{}, {} iterations, {} faces broken)",
           clock.now.time, text_of(phase.reason), phase.solves, by, phase.iterations, phase.broken);
  phases.push_back(phase);
  return walk.stop();
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
    phase.seconds = work_->dynamic_seconds();
    phases.push_back(phase);
  }
  for (const Phase &p : phases)
    entries.push_back(entry_of(p, clock.now.dt));
  return entries;
}

template <int dim>
void StaticPhases<dim>::save(core::State &state) const
{
  if (!work_)
    return;
  core::save_value(state, "static_phases", "dynamic_since", std::int64_t(work_->dynamic_since));
  core::save_value(state, "static_phases", "broken_then", std::int64_t(work_->broken_then));
  core::save_value(state, "static_phases", "is_restless", std::int64_t(work_->is_restless));
  core::save_value(state, "static_phases", "goes_on", std::int64_t(work_->goes_on));
  core::save_value(state, "static_phases", "skipped", std::int64_t(work_->skipped));
  core::save_value(state, "static_phases", "residual", work_->residual);
  core::save_value(state, "static_phases", "dynamic_seconds", work_->dynamic_seconds());
  const bool has_solver = work_->solver.has_value();
  core::save_value(state, "static_phases", "largest_load",
                   has_solver ? work_->solver->largest_load() : work_->largest_load);
  core::save_value(state, "static_phases", "stretching_energy", work_->stretching_energy);
  core::save_value(state, "static_phases_held", "energy", work_->held_energy);
  // Found again, in a body in which bonds have broken, they would differ by round-off.
  const auto free = has_solver ? work_->solver->free_shares() : work_->free_shares;
  core::save_value(state, "static_phases", "free_motions", std::int64_t(free.n));
  core::Table shares = numbered_rows(free.shares.size());
  shares.add("share", free.shares);
  state["free_motions"] = std::move(shares);
  state["phases"] = table_of(work_->phases);
}

template <int dim>
void StaticPhases<dim>::load(const core::State &state)
{
  if (!work_)
    return;
  work_->dynamic_since = long(core::load_integer(state, "static_phases", "dynamic_since"));
  work_->broken_then = long(core::load_integer(state, "static_phases", "broken_then"));
  work_->is_restless = core::load_integer(state, "static_phases", "is_restless") != 0;
  work_->goes_on = core::load_integer(state, "static_phases", "goes_on") != 0;
  work_->skipped = int(core::load_integer(state, "static_phases", "skipped"));
  work_->residual = core::load_real(state, "static_phases", "residual");
  work_->dynamic_before = core::load_real(state, "static_phases", "dynamic_seconds");
  work_->dynamic_began = std::chrono::steady_clock::now();
  work_->largest_load = core::load_real(state, "static_phases", "largest_load");
  work_->stretching_energy = core::load_real(state, "static_phases", "stretching_energy");
  if (state.count("static_phases_held")) // which older checkpoints don't have
    work_->held_energy = core::load_real(state, "static_phases_held", "energy");
  work_->free_shares = {int(core::load_integer(state, "static_phases", "free_motions")),
                        core::table(state, "free_motions").reals("share")};
  if (work_->solver) {
    work_->solver->set_largest_load(work_->largest_load);
    work_->solver->set_free_shares(work_->free_shares);
  }
  work_->phases = phases_of(core::table(state, "phases"));
}

template class StaticPhases<2>;
template class StaticPhases<3>;
} // namespace ligament::program
