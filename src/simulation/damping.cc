#include "src/simulation/damping.h"

#include <cmath>

namespace ligament::program
{
namespace
{
/// damping <- -fraction |force| sign(velocity); force += damping
template <std::size_t n>
void oppose(double fraction, const std::array<std::vector<double>, n> &velocity,
            std::array<std::vector<double>, n> &force, std::array<std::vector<double>, n> &damping)
{
  for (std::size_t c = 0; c < n; ++c)
  {
    damping[c].resize(force[c].size());
    for (std::size_t i = 0; i < force[c].size(); ++i)
    {
      const double v = velocity[c][i];
      damping[c][i] = v == 0 ? 0 : -fraction * std::copysign(std::abs(force[c][i]), v);
      force[c][i] += damping[c][i];
    }
  }
}

template <std::size_t n>
double power(const std::array<std::vector<double>, n> &velocity,
             const std::array<std::vector<double>, n> &force)
{
  double sum = 0;
  for (std::size_t c = 0; c < n; ++c)
    for (std::size_t i = 0; i < force[c].size(); ++i)
      sum += velocity[c][i] * force[c][i];
  return sum;
}
} // namespace

// Supports prescribe the motion of held nodes: damping forces there would only falsify reactions.
template <int dim>
void BodyDamping<dim>::add_local_forces(CoupledBody<dim> &body, bool far_acts)
{
  if (body.zone)
  {
    auto &state = body.zone->state;
    oppose(parameters_.local, state.velocity, state.force, zone_force_);
    oppose(parameters_.local, state.spin, state.torque, zone_torque_);
  }
  if (body.far)
  {
    auto &far = *body.far;
    if (!far_acts)
    {
      for (auto &f : far_force_)
        f.assign(far.mesh().n_nodes(), 0.);
      return;
    }
    oppose(parameters_.local, far.velocity, far.force, far_force_);
    for (int c = 0; c < dim; ++c)
      for (int i = 0; i < far.mesh().n_nodes(); ++i)
        if (far.is_held(i, c))
        {
          far.force[c][i] -= far_force_[c][i];
          far_force_[c][i] = 0;
        }
  }
}

template <int dim>
double BodyDamping<dim>::local_power(const CoupledBody<dim> &body) const
{
  double sum = 0;
  if (body.zone)
    sum += power(body.zone->state.velocity, zone_force_) + power(body.zone->state.spin, zone_torque_);
  if (body.far)
    sum += body.coupler->step_ratio() * power(body.far->velocity, far_force_);
  return sum;
}

template <int dim>
void BodyDamping<dim>::before_kick(CoupledBody<dim> &body, const coupling::StepTime &step)
{
  if (parameters_.local == 0)
    return;
  add_local_forces(body, step.step % body.coupler->step_ratio() == 0);
  energy_ -= 0.5 * step.dt * local_power(body);
}

template <int dim>
void BodyDamping<dim>::after_kick(CoupledBody<dim> &body, const coupling::StepTime &step)
{
  if (parameters_.local > 0)
    energy_ -= 0.5 * step.dt * local_power(body);
  auto bodies = body.bodies();
  if (parameters_.mass > 0)
    energy_ += body.coupler->scale_velocities(bodies, step, std::exp(-parameters_.mass * step.dt));
  if (parameters_.kinetic && step.step % body.coupler->step_ratio() == 0)
  {
    const auto energy = body.coupler->energy(bodies, step);
    const double kinetic = energy.kinetic_discrete + energy.kinetic_far;
    const bool falls = kinetic < last_kinetic_;
    last_kinetic_ = kinetic;
    if (falls)
    {
      energy_ += body.coupler->scale_velocities(bodies, step, 0);
      last_kinetic_ = 0;
    }
  }
}

template class BodyDamping<2>;
template class BodyDamping<3>;
} // namespace ligament::program
