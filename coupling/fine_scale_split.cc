#include "coupling/fine_scale_split.h"

#include "core/check.h"
#include "core/exact_sum.h"
#include "coupling/operators/blended_cells.h"
#include "coupling/operators/fine_damper.h"
#include "coupling/operators/gap_filter.h"

#include <fmt/format.h>

#include <cmath>

namespace ligament::coupling
{
template <int dim>
FineScaleSplit<dim>::FineScaleSplit(Bodies<dim> &bodies, const OverlapParameters<dim> &overlap,
                                    const FineScaleSplitParameters &parameters, double dt,
                                    core::Timers &timers, const fem::Body<dim> *still,
                                    const particles::ParticleSolver<dim> *whole)
    : Coupler<dim>(timers), parameters_(parameters), whole_(whole ? whole : bodies.zone),
      overlap_(whole_->state, *whole_->force, bodies.far->mesh(), overlap),
      at_hand_(whole ? std::make_unique<Overlap<dim>>(
                           overlap_at_hand<dim>({overlap_, whole->state}, bodies.zone->state))
                     : nullptr),
      near_(*bodies.far, overlap_.near_nodes),
      fine_(
          {overlap_, whole_->state}, {here(), bodies.zone->state},
          [&, speed = bodies.zone->force->elastic_constants().wave_speed_p](double s) {
            const double rate =
                fine_damper_rate(parameters.fine_damper, speed, overlap_.cell_size, s);
            return parameters.thermal_energy > 0 ? 0 : 1 - std::exp(-rate * dt);
          },
          parameters.solver, bodies.zone->ranks()),
      parts_(overlap_), mass_solver_(make_linear_solver(parameters.solver))
{
  auto &far = *bodies.far;
  const int n = overlap_.n_nodes();
  const fem::Body<dim> &near_body = still ? *still : far.body();
  const auto operators = make_blended_operators(overlap_, whole_->state, *whole_->force, near_body,
                                                parameters.coarse_mass);
  stiffness_ = operators.stiffness;
  if (parameters.patch_fit) {
    const PatchFit fit = fit_patch(overlap_, operators, near_body);
    correction_ = fit.correction;
    stiffness_ += correction_;
    report_.patch_residual_before = fit.residual_before;
    report_.patch_residual = fit.residual;
    report_.patch_modulus = fit.largest_modulus;
    core::require(fit.residual < 1e-12,
                  fmt::format("the patch fit leaves a residual of {:.1e} (of C11 h^(dim-1)): the "
                              "overlap's shape is not supported; widen /coupling/overlap_cells or "
                              "keep the overlap away from corners, holes and loads",
                              fit.residual));
  }
  if (still)
    stiffness_ += change_of_cells_alone(overlap_, *still, far.body());
  dead_load_ = operators.dead_load;
  coarse_ = std::make_unique<LinearCoarseEnergy<dim>>(stiffness_, dead_load_);
  linear_ = std::make_unique<LinearCoarseEnergy<dim>>(stiffness_);

  Eigen::SparseMatrix<double> mass = take_over_cells(overlap_, far);
  mass += operators.mass;
  mass_solver_->factorise(mass);
  mass_ = mass;

  const auto &force = *bodies.zone->force;
  can_strain_ =
      !force.is_prestressed() ||
      (force.finite_strain_law() && near_body.stress.isZero(0) && parameters.thermal_energy == 0);
  const auto constants = force.elastic_constants();
  if (parameters.gap_filter > 0)
    filter_ =
        ScalarMatrix<dim>(make_gap_filter(overlap_, parameters.gap_filter, constants.wave_speed_p,
                                          parameters.step_ratio * dt, operators.mass_bound));
  force_ = change_ = Nodal<dim>::Zero(n, dim);
  report_.overlap_particles = int(overlap_.members.size());
  for (const auto &member : overlap_.members)
    report_.pad_particles += member.pad && whole_->state.turns;
  report_.near_nodes = n;
  bodies.zone->force->set_coupled_edge(bodies.zone->state, here().coupled_edge(far.displacement));
  for (const double period : overlap.period)
    is_periodic_ = is_periodic_ || period > 0;
  if (parameters.thermal_energy > 0)
    join_bath(bodies, dt);
  // Of a body in parts the whole overlap is a copy in which nothing breaks.
  if (parameters.may_become_nonlinear && can_strain_ && whole_ == bodies.zone)
    strained_ = strained_energy(bodies);
  take_velocities(bodies);
}

template <int dim>
void FineScaleSplit<dim>::take_velocities(Bodies<dim> &bodies)
{
  if (regime_ != Regime::linear)
    fine_.turn_pads(near_.displacement(), bodies.zone->state);
  fine_.take_velocities(near_.velocity(), bodies.zone->state);
}

template <int dim>
void FineScaleSplit<dim>::set_regime(Regime regime, Bodies<dim> &bodies)
{
  if (regime == regime_)
    return;
  core::require(regime != Regime::linear, "an overlap that turns cannot be linear again");
  make_coarse_energy(regime, bodies);
  fine_.turn_pads(near_.displacement(), bodies.zone->state);
  fine_.write_velocities(near_.velocity(), bodies.zone->state);
  bodies.zone->update_ghosts(); // among them pads that have turned
}

template <int dim>
void FineScaleSplit<dim>::make_coarse_energy(Regime regime, const Bodies<dim> &bodies)
{
  bodies.far->set_corotated(true);
  if (regime == Regime::corotated)
    coarse_ = std::make_unique<CorotatedCoarseEnergy<dim>>(stiffness_, parts_, dead_load_);
  else {
    const auto &force = *whole_->force;
    core::require(
        can_strain(),
        "/coupling/regime: bonds bear a stress in the reference, which cells under finite "
        "strain don't know; choose \"linear\" or \"corotated\"");
    coarse_ = strained_ ? std::move(strained_) : strained_energy(bodies);
    if (const auto law = force.finite_strain_law())
      bodies.far->set_strain_law(law);
  }
  fast_.reset();
  if (regime == Regime::nonlinear && parameters_.step_ratio > 1) {
    fast_ = std::make_unique<CorotatedCoarseEnergy<dim>>(stiffness_, parts_, dead_load_);
    slow_force_ = slow_force_at(near_.displacement());
  }
  regime_ = regime;
}

template <int dim>
std::unique_ptr<CoarseEnergy<dim>>
FineScaleSplit<dim>::strained_energy(const Bodies<dim> &bodies) const
{
  return std::make_unique<NonlinearCoarseEnergy<dim>>(overlap_, parts_, whole_->state,
                                                      *whole_->force, bodies.far->body(),
                                                      correction_, dead_load_);
}

template <int dim>
void FineScaleSplit<dim>::drift(Bodies<dim> &bodies, const StepTime &step)
{
  {
    const auto timing = this->timers_.scope(this->motion_);
    bodies.zone->drift(step.dt);
  }
  if (!rests_)
    near_.drift(step.dt);
  if (regime_ != Regime::linear)
    fine_.turn_pads(near_.displacement(), bodies.zone->state);
  {
    const auto timing = this->timers_.scope(this->motion_);
    bodies.zone->update_ghosts(); // pads turn before they are sent
  }
  // The rest of the far field moves in one go, just before it acts again: it is needed nowhere in
  // between.
  if ((step.step + 1) % parameters_.step_ratio == 0 && !far_rests_) {
    const auto timing = this->timers_.scope(this->far_);
    bodies.far->drift(parameters_.step_ratio * step.dt);
  }
}

template <int dim>
void FineScaleSplit<dim>::compute_forces(Bodies<dim> &bodies, const StepTime &step)
{
  {
    const auto timing = this->timers_.scope(this->forces_);
    bodies.zone->compute_forces(step.time);
  }
  if (fast_ && is_far_step(step) && !rests_) {
    const auto timing = this->timers_.scope(this->coupling_);
    slow_force_ = slow_force_at(near_.displacement());
  }
  if (is_far_step(step) && !far_rests(bodies, step)) {
    const auto timing = this->timers_.scope(this->far_);
    bodies.far->compute_forces(step.time);
  }
}

template <int dim>
double FineScaleSplit<dim>::coarse_kinetic(const Halfway &near, double dt) const
{
  // Less the (dt^2/8) F M^-1 F of (E1); for m = 1 this is 1/2 V(-) M V(+).
  const Nodal<dim> momentum = mass_ * near.velocity;
  return 0.5 * near.velocity.cwiseProduct(momentum).sum() -
         dt * dt / 8 * near.force.cwiseProduct(near.acceleration).sum();
}

template <int dim>
double FineScaleSplit<dim>::fine_kinetic(const Bodies<dim> &bodies, double dt) const
{
  const auto &zone = *bodies.zone;
  const auto sums = zone.ranks().sum(
      {fine_.kinetic_sum(zone.state, dt), zone.kinetic_sum(dt), member_kinetic(zone.state, dt)});
  return sums[0].value() + sums[1].value() - sums[2].value();
}

template <int dim>
core::ExactSum FineScaleSplit<dim>::member_kinetic(const particles::Particles<dim> &zone,
                                                   double dt) const
{
  core::ExactSum sum;
  for (const auto &member : here().members) {
    const int i = member.particle;
    if (!zone.part.owns(i))
      continue;
    double twice = 0;
    for (int c = 0; c < dim; ++c)
      twice += zone.velocity[c][i] * (zone.mass[i] * zone.velocity[c][i] + dt * zone.force[c][i]);
    for (int c = 0; c < n_spins<dim> && member.pad && zone.turns; ++c)
      twice += zone.spin[c][i] * (zone.inertia(i) * zone.spin[c][i] + dt * zone.torque[c][i]);
    sum.add(twice / 2);
  }
  return sum;
}

template <int dim>
void FineScaleSplit<dim>::kick(Bodies<dim> &bodies, const StepTime &step)
{
  look(bodies, step);
  ++kicks_;
  rested_ += rests_;
  far_rested_ += far_rests_;
  if (is_far_step(step) && !far_rests_) {
    const auto timing = this->timers_.scope(this->far_);
    bodies.far->kick(parameters_.step_ratio * step.dt, step.time);
  }
  {
    const auto timing = this->timers_.scope(this->motion_);
    bodies.zone->kick(step.dt);
  }
  if (rests_)
    return;
  const auto timing = this->timers_.scope(this->coupling_);
  compute_mesh_force(step, force_);
  fine_.begin_kick(bodies.zone->state, step.dt, force_);
  kick_coarse(step);
  fine_.finish_kick(near_.velocity(), bodies.zone->state);
  if (zone_bath_)
    exchange_heat(bodies, step);
}

// V += M_c^-1 dt F. Between two impulses of the far field V swings about its mean, most where the
// body is strained most: the gap-band filter acts with the impulse, on V half-way through it.
template <int dim>
void FineScaleSplit<dim>::kick_coarse(const StepTime &step)
{
  change_ = step.dt * force_;
  mass_solver_->solve(change_.data(), dim);
  if (filter_.is_empty() || !is_far_step(step)) {
    near_.add_velocity(1, change_);
    return;
  }
  middle_ = near_.velocity() + 0.5 * change_;
  filter_.multiply(middle_, lost_); // momentum
  near_.add_velocity(1, change_);
  change_ = lost_;
  mass_solver_->solve(change_.data(), dim);
  near_.add_velocity(-1, change_);
  // theory.md eq. (E3); the mean of V before and after is middle_ - change_ / 2
  gap_filter_energy_ += lost_.cwiseProduct(middle_ - 0.5 * change_).sum();
}

template <int dim>
void FineScaleSplit<dim>::scale_velocities(Bodies<dim> &bodies, double factor)
{
  bodies.zone->scale_velocities(factor);
  bodies.far->scale_velocities(factor);
  fine_.scale(factor);
  fine_.write_velocities(near_.velocity(), bodies.zone->state);
}

// The far field keeps its velocities for m steps and takes their damping at once; so does V, which
// the impulses of the far field move.
template <int dim>
double FineScaleSplit<dim>::damp_velocities(Bodies<dim> &bodies, const StepTime &step,
                                            double factor)
{
  const auto timing = this->timers_.scope(this->coupling_);
  auto &zone = *bodies.zone;
  std::vector<core::ExactSum> sums = {
      fine_.kinetic_sum(zone.state, 0), fine_.kinetic_sum(zone.state, step.dt),
      member_kinetic(zone.state, 0), member_kinetic(zone.state, step.dt)};
  sums.push_back(zone.damp_velocities(factor, step.dt)); // changes what the others read
  sums = zone.ranks().sum(sums);
  double loss = scaling_loss(sums[0].value(), sums[1].value(), factor) -
                scaling_loss(sums[2].value(), sums[3].value(), factor) + sums[4].value();
  fine_.scale(factor);
  if (is_far_step(step)) {
    const double whole = std::pow(factor, parameters_.step_ratio);
    if (step.dt > 0) {
      look(bodies, step);
      loss += damp_coarse_before_kick(step.dt, whole);
    } else
      loss +=
          damped_impulse_energy(bodies, -step.dt, whole) + damp_coarse_after_kick(-step.dt, whole);
    loss += bodies.far->damp_velocities(parameters_.step_ratio * step.dt);
  }
  fine_.write_velocities(near_.velocity(), zone.state);
  return loss;
}

template <int dim>
CoupledEnergy FineScaleSplit<dim>::energy(const Bodies<dim> &bodies, const StepTime &step) const
{
  CoupledEnergy e;
  e.fine_damper = fine_.damper_energy();
  e.gap_filter = gap_filter_energy_;
  if (zone_bath_)
    e.thermostat = fine_.bath_energy() + zone_bath_->taken;
  e.potential_discrete = bodies.zone->potential_energy();
  e.potential_far = bodies.far->potential_energy();
  Nodal<dim> force = Nodal<dim>::Zero(overlap_.n_nodes(), dim);
  e.blended = coarse_->subtract_forces(near_.displacement(), force);
  const Halfway near = halfway(bodies, step);
  e.kinetic_far =
      bodies.far->kinetic_energy(parameters_.step_ratio * step.dt) + coarse_kinetic(near, step.dt);
  e.impulses = impulse_energy(bodies, near, step.dt);
  e.kinetic_discrete = fine_kinetic(bodies, step.dt);
  return e;
}

template <int dim>
void FineScaleSplit<dim>::save(core::State &state, const Bodies<dim> &bodies) const
{
  fine_.save(state, bodies.zone->state);
  core::save_value(state, "split", "regime", std::int64_t(regime_));
  core::save_value(state, "split", "gap_filter_energy", gap_filter_energy_);
  core::save_value(state, "split_rest", "rests", std::int64_t(rests_));
  core::save_value(state, "split_rest", "far_rests", std::int64_t(far_rests_));
  core::save_value(state, "split_rest", "kicks", std::int64_t(kicks_));
  core::save_value(state, "split_rest", "rested", std::int64_t(rested_));
  core::save_value(state, "split_rest", "far_rested", std::int64_t(far_rested_));
  if (zone_bath_)
    save_bath(state);
}

// Velocities and orientations of the members are those of the particles' state: nothing is written
// to them, lest they change in the last bit.
template <int dim>
void FineScaleSplit<dim>::load(const core::State &state, Bodies<dim> &bodies)
{
  auto &zone = bodies.zone->state;
  const auto regime = Regime(core::load_integer(state, "split", "regime"));
  if (regime != regime_)
    make_coarse_energy(regime, bodies);
  fine_.load(state, zone);
  if (regime_ != Regime::linear)
    fine_.turn_pads(near_.displacement(), zone);
  gap_filter_energy_ = core::load_real(state, "split", "gap_filter_energy");
  const auto load = [&](const char *column) {
    return core::load_integer(state, "split_rest", column);
  };
  rests_ = load("rests");
  far_rests_ = load("far_rests");
  kicks_ = load("kicks");
  rested_ = load("rested");
  far_rested_ = load("far_rested");
  if (bodies.zone->rest() && !rests_) // parts of particles don't say who had been woken
    wake_members(bodies);
  if (zone_bath_)
    load_bath(state, bodies);
}

template class FineScaleSplit<2>;
template class FineScaleSplit<3>;
} // namespace ligament::coupling
