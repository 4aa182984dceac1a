#include "src/simulation/regime_control.h"

#include "src/output/format.h"
#include "src/simulation/energy_ledger.h"
#include "src/simulation/kept_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
using coupling::Regime;

constexpr long look_interval = 50; // steps of the far field
constexpr double degree = M_PI / 180;

// A linear model that turns by phi feels a strain of phi^2/2: 1.5e-6 at the change of regime,
// 4e-5 at the limit of a fixed regime.
constexpr double change_at = 0.1 * degree, limit = 0.5 * degree;

// The linear matrices of a turning overlap err by the strain squared. Bonds between atoms are 2 to
// 3 % stiffer or softer for each per cent of strain.
constexpr double largest_corotated_strain = 0.01, largest_linear_strain = 1e-3;

// The laws of both models are meant for strains up to here; beyond the second a crystal is near to
// where it is no longer stable.
constexpr double largest_strain = 0.1, largest_crystal_strain = 0.08;

// Of an overlap that knows no finite strain but stands for bonds that do.
constexpr double largest_strain_of_linear = 0.03;
// Which errs by as much as a strain of 1e-3, phi^2/2.
constexpr double largest_corotated_bending = 2.5 * degree;

// Over which the motion of warm bodies is averaged, in critical steps of the far field: three
// periods of its fastest vibration.
constexpr double mean_steps = 10;

std::string mean_name(int c)
{
  return std::string("mean_") + "xyz"[c];
}
} // namespace

template <int dim>
RegimeControl<dim>::RegimeControl(RegimeChoice choice, CoupledBody<dim> &body, bool is_warm,
                                  bool turns)
    : can_turn_(body.coupler->can_turn()), can_strain_(body.coupler->can_strain()),
      has_law_(body.force() && body.force()->finite_strain_law()),
      automatic_(choice == RegimeChoice::automatic && can_turn_)
{
  if (!body.far)
    return;
  // By the first look it may have turned so far that its false strains stay as waves.
  if (choice == RegimeChoice::corotated || (automatic_ && turns))
    set(Regime::corotated, body);
  else if (choice == RegimeChoice::nonlinear)
    set(Regime::nonlinear, body);
  history_.emplace_back(regime_, 0);
  if (is_warm)
    for (auto &component : mean_)
      component.assign(body.far->mesh().n_nodes(), 0.);
}

template <int dim>
void RegimeControl<dim>::follow(const CoupledBody<dim> &body, double dt)
{
  const double share = std::min(1., dt / (mean_steps * body.dt_far));
  for (int c = 0; c < dim; ++c)
    for (std::size_t i = 0; i < mean_[c].size(); ++i)
      mean_[c][i] += share * (body.far->displacement[c][i] - mean_[c][i]);
}

// The coupler reads the far field's displacements. Ranks see no more than their parts, and change
// the regime together.
template <int dim>
void RegimeControl<dim>::measure(CoupledBody<dim> &body)
{
  const bool by_mean = !mean_[0].empty();
  if (by_mean)
    std::swap(body.far->displacement, mean_);
  far_ = body.far->largest_motion();
  near_ = body.coupler->largest_motion();
  if (by_mean)
    std::swap(body.far->displacement, mean_);
  struct Seen
  {
    coupling::NearMotion<dim> near;
    typename fem::FemSolver<dim>::Motion far;
  };
  for (const auto &[near, far] : body.ranks.gather_all(std::vector<Seen>{{near_, far_}})) {
    near_.rotation.take(near.rotation);
    near_.bending.take(near.bending);
    near_.strain.take(near.strain);
    far_.rotation.take(far.rotation);
    far_.strain.take(far.strain);
  }
}

template <int dim>
void RegimeControl<dim>::set(Regime regime, CoupledBody<dim> &body)
{
  auto bodies = body.bodies();
  body.coupler->set_regime(regime, bodies);
  regime_ = regime;
}

template <int dim>
Regime RegimeControl<dim>::needed() const
{
  const double strain = has_law_ ? this->strain().value : near_.strain.value,
               most = has_law_ ? largest_linear_strain : largest_corotated_strain;
  if (can_strain_ && (near_.bending.value > change_at || strain > most))
    return Regime::nonlinear;
  return rotation().value > change_at ? Regime::corotated : Regime::linear;
}

template <int dim>
double RegimeControl<dim>::largest_allowed_strain() const
{
  if (!can_strain_)
    return largest_strain_of_linear;
  return has_law_ ? largest_crystal_strain : largest_strain;
}

template <int dim>
std::optional<std::string> RegimeControl<dim>::excess() const
{
  if (strain().value > largest_allowed_strain())
    return fmt::format("overlap or far field is strained by {:.1f} % at {}, more than its law is "
                       "for; make /discrete_zone/region larger or end the run earlier",
                       100 * strain().value, place(strain().place));
  if (regime_ == Regime::linear && rotation().value > limit)
    return fmt::format("overlap or far field has turned by {:.2f} degrees at {}, more than the "
                       "linear regime carries; {}",
                       rotation().value / degree, place(rotation().place),
                       can_turn_ ? "set /coupling/regime to \"automatic\""
                                 : "energy-weighted schemes have no other: hold the specimen "
                                   "against rotation or end the run earlier");
  if (regime_ == Regime::corotated &&
      near_.bending.value > (can_strain_ ? limit : largest_corotated_bending))
    return fmt::format(
        "the overlap bends by {:.2f} degrees at {}, more than one rotation carries; {}",
        near_.bending.value / degree, place(near_.bending.place),
        can_strain_ ? "set /coupling/regime to \"automatic\" or \"nonlinear\""
                    : "overlaps of atoms know no more: make /discrete_zone/region larger or end "
                      "the run earlier");
  return {};
}

template <int dim>
std::optional<std::string> RegimeControl<dim>::look(CoupledBody<dim> &body,
                                                    const coupling::StepTime &step, core::Log &log,
                                                    bool each)
{
  const int ratio = body.coupler->step_ratio();
  if (body.far && step.step % ratio == 0)
    follow(body, ratio * step.dt);
  if (!body.far || (!each && step.step % (ratio * look_interval) != 0))
    return {};
  measure(body);
  const Regime needed = automatic_ ? this->needed() : regime_;
  if (needed > regime_) {
    auto bodies = body.bodies();
    const double before = motion_energy(body, step);
    set(needed, body);
    body.coupler->compute_forces(bodies, step);
    if (body.tools)
      body.tools->push_again(bodies);
    const double jump = motion_energy(body, step) - before;
    body.regime_change -= jump;
    history_.emplace_back(regime_, step.time);
    log.info("{} regime from {:.4g} s: rotation {:.2f} degrees, bending {:.2f} degrees, strain "
             "{:.2g}; the energy changes by {:.3g} J",
             name_of(regime_), step.time, rotation().value / degree, near_.bending.value / degree,
             strain().value, jump);
  }
  if (warned_)
    return {};
  const auto reason = excess();
  warned_ = reason.has_value();
  return reason;
}

template <int dim>
std::string RegimeControl<dim>::history() const
{
  std::string text;
  for (const auto &[regime, time] : history_)
    text +=
        text.empty() ? name_of(regime) : fmt::format(", {} from {:.4g} s", name_of(regime), time);
  return text;
}

template <int dim>
void RegimeControl<dim>::save(core::State &state) const
{
  std::vector<std::int64_t> regimes;
  std::vector<double> times;
  for (const auto &[regime, time] : history_) {
    regimes.push_back(std::int64_t(regime));
    times.push_back(time);
  }
  core::Table rows = numbered_rows(history_.size());
  rows.add("regime", regimes);
  rows.add("time", times);
  state.emplace("regimes", std::move(rows));
  if (!mean_[0].empty()) {
    core::Table nodes = numbered_rows(mean_[0].size());
    for (int c = 0; c < dim; ++c)
      nodes.add(mean_name(c), mean_[c]);
    state.emplace("mean_motion", std::move(nodes));
  }
  core::save_value(state, "regime", "warned", std::int64_t(warned_));
}

template <int dim>
void RegimeControl<dim>::load(const core::State &state, CoupledBody<dim> &body)
{
  const core::Table &rows = core::table(state, "regimes");
  const auto regimes = rows.integers("regime");
  const auto times = rows.reals("time");
  history_.clear();
  for (std::size_t k = 0; k < times.size(); ++k)
    history_.emplace_back(Regime(regimes[k]), times[k]);
  if (!history_.empty() && history_.back().first != regime_)
    set(history_.back().first, body);
  if (!mean_[0].empty())
    for (int c = 0; c < dim; ++c)
      mean_[c] = core::table(state, "mean_motion").reals(mean_name(c));
  warned_ = core::load_integer(state, "regime", "warned") != 0;
}

template class RegimeControl<2>;
template class RegimeControl<3>;
} // namespace ligament::program
