#include "src/simulation/damping.h"

#include "core/exact_sum.h"
#include "src/simulation/energy_ledger.h"

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
/// damping <- -min(fraction |force|, what stops it) sign(velocity); force += damping. The velocity
/// is the one half-way through the kick: at large steps stiff modes change sign in every step, and
/// a force against the old velocity would drive them. Of the entries in these ranges.
template <std::size_t n, typename InverseMass>
void oppose(double fraction, double dt, const particles::ParticleRanges &entries,
            const InverseMass &inverse_mass, const std::array<std::vector<double>, n> &velocity,
            std::array<std::vector<double>, n> &force, std::array<std::vector<double>, n> &damping)
{
  for (std::size_t c = 0; c < n; ++c) {
    damping[c].resize(force[c].size());
    particles::for_each(entries, [&](int i) {
      const double half = 0.5 * dt * inverse_mass(i);
      const double v = velocity[c][i] + half * force[c][i];
      const double f = fraction * std::abs(force[c][i]);
      damping[c][i] = -std::copysign(half > 0 ? std::min(f, std::abs(v) / half) : 0, v);
      force[c][i] += damping[c][i];
    });
  }
}

template <std::size_t n>
double power(const particles::ParticleRanges &entries,
             const std::array<std::vector<double>, n> &velocity,
             const std::array<std::vector<double>, n> &force, const core::Ranks &ranks)
{
  core::ExactSum sum;
  particles::for_each(entries, [&](int i) {
    double power = 0;
    for (std::size_t c = 0; c < n; ++c)
      power += velocity[c][i] * force[c][i];
    sum.add(power);
  });
  return ranks.sum(sum).value();
}
} // namespace

/// force -= damping, damping <- 0 in all components of entry i.
template <std::size_t n>
void release(int i, std::array<std::vector<double>, n> &force,
             std::array<std::vector<double>, n> &damping)
{
  for (std::size_t c = 0; c < n; ++c) {
    force[c][i] -= damping[c][i];
    damping[c][i] = 0;
  }
}

// Supports prescribe the motion of held nodes: damping forces there would only falsify reactions.
// The forces of a pad, of a member with an energy weight, and of the far field on nodes that the
// coupler moves are parts of a sum: alone they don't vanish at rest, and damping in their
// proportion would hold the body off balance.
template <int dim>
void BodyDamping<dim>::add_local_forces(CoupledBody<dim> &body, double dt, bool far_acts)
{
  if (body.zone) {
    auto &state = body.zone->state;
    const auto &stepped = state.part.stepped;
    oppose(
        parameters_.local, dt, stepped, [&](int i) { return state.inverse_mass(i); },
        state.velocity, state.force, zone_force_);
    if (state.turns)
      oppose(
          parameters_.local, dt, stepped, [&](int i) { return state.inverse_inertia(i); },
          state.spin, state.torque, zone_torque_);
    if (const auto *overlap = body.coupler->overlap())
      for (const auto &member : overlap->members)
        if (member.pad || !overlap->parameters.has_pads) {
          release(member.particle, state.force, zone_force_);
          if (state.turns)
            release(member.particle, state.torque, zone_torque_);
        }
  }
  if (body.far) {
    auto &far = *body.far;
    if (!far_acts) {
      for (auto &f : far_force_)
        f.assign(far.mesh().n_nodes(), 0.);
      return;
    }
    if (inverse_far_mass_.empty())
      for (const double mass : far.lumped_mass())
        inverse_far_mass_.push_back(mass > 0 ? 1 / mass : 0);
    oppose(
        parameters_.local, dt * body.coupler->step_ratio(), {{0, far.mesh().n_nodes()}},
        [&](int i) { return inverse_far_mass_[i]; }, far.velocity, far.force, far_force_);
    if (const auto *overlap = body.coupler->overlap())
      for (const int node : overlap->near_nodes)
        release(node, far.force, far_force_);
    for (int c = 0; c < dim; ++c)
      for (int i = 0; i < far.mesh().n_nodes(); ++i)
        if (far.is_held(i, c)) {
          far.force[c][i] -= far_force_[c][i];
          far_force_[c][i] = 0;
        }
  }
}

template <int dim>
double BodyDamping<dim>::local_power(const CoupledBody<dim> &body) const
{
  double sum = 0;
  if (body.zone) {
    const auto &state = body.zone->state;
    sum += power(state.part.owned, state.velocity, zone_force_, body.ranks);
    if (state.turns)
      sum += power(state.part.owned, state.spin, zone_torque_, body.ranks);
  }
  if (body.far)
    sum += body.coupler->step_ratio() *
           power({{0, body.far->mesh().n_nodes()}}, body.far->velocity, far_force_, {});
  return sum;
}

template <int dim>
double BodyDamping<dim>::damp_half_a_step(CoupledBody<dim> &body, const coupling::StepTime &step)
{
  auto bodies = body.bodies();
  return body.coupler->damp_velocities(bodies, step,
                                       std::exp(-parameters_.mass * std::abs(step.dt) / 2));
}

template <int dim>
void BodyDamping<dim>::before_kick(CoupledBody<dim> &body, const coupling::StepTime &step)
{
  const bool far_acts = step.step % body.coupler->step_ratio() == 0;
  if (body.far)
    body.far->set_mass_damping(parameters_.mass);
  if (parameters_.kinetic && far_acts) {
    auto bodies = body.bodies();
    const auto energy = body.coupler->energy(bodies, step);
    const double kinetic = energy.kinetic_discrete + energy.kinetic_far;
    restarts_ = kinetic < last_kinetic_;
    last_kinetic_ = restarts_ ? 0 : kinetic;
    if (restarts_) {
      energy_ += read_ledger(body, step, 0).residual();
      body.coupler->scale_velocities(bodies, 0);
    }
  }
  if (parameters_.mass > 0)
    energy_ += damp_half_a_step(body, step);
  if (parameters_.local > 0 && !restarts_) {
    add_local_forces(body, step.dt, far_acts);
    energy_ -= 0.5 * step.dt * local_power(body);
  }
}

template <int dim>
void BodyDamping<dim>::after_kick(CoupledBody<dim> &body, const coupling::StepTime &step)
{
  // Mass damping books with the local forces as parts of the others: it goes first, so that the
  // power left to book is that of the damped velocities.
  if (parameters_.mass > 0)
    energy_ += damp_half_a_step(body, {step.step, step.time, -step.dt});
  if (parameters_.local > 0 && !restarts_)
    energy_ -= 0.5 * step.dt * local_power(body);
  auto bodies = body.bodies();
  // Rest at the time of the positions means half a kick half a step later. Rest half a step later
  // would let stiff modes grow: by 1/sqrt(1 - (omega dt/2)^2) with each restart.
  if (restarts_) {
    body.coupler->scale_velocities(bodies, 0.5);
    const coupling::StepTime backwards = {step.step, step.time, -step.dt};
    energy_ -= read_ledger(body, backwards, 0).residual();
  }
  restarts_ = false;
}

template <int dim>
void BodyDamping<dim>::save(core::State &state) const
{
  core::save_value(state, "damping", "energy", energy_);
  core::save_value(state, "damping", "last_kinetic", last_kinetic_);
}

template <int dim>
void BodyDamping<dim>::load(const core::State &state)
{
  energy_ = core::load_real(state, "damping", "energy");
  last_kinetic_ = core::load_real(state, "damping", "last_kinetic");
}

template class BodyDamping<2>;
template class BodyDamping<3>;
} // namespace ligament::program
