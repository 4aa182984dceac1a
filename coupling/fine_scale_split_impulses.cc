// What acts on the near nodes once per m steps, and what that takes from the energy (theory.md
// section 5.1).
#include "coupling/fine_scale_split.h"

#include <cmath>

namespace ligament::coupling
{
template <int dim>
void FineScaleSplit<dim>::add_impulse(double factor, Nodal<dim> &force) const
{
  near_.add_force(factor, force);
  if (fast_)
    force += factor * slow_force_;
}

template <int dim>
Nodal<dim> FineScaleSplit<dim>::slow_force_at(const Nodal<dim> &u) const
{
  Nodal<dim> whole = Nodal<dim>::Zero(u.rows(), dim), fast = whole;
  coarse_->subtract_only_forces(u, whole);
  fast_->subtract_only_forces(u, fast);
  return whole - fast;
}

template <int dim>
void FineScaleSplit<dim>::compute_mesh_force(const StepTime &step, Nodal<dim> &force) const
{
  force.setZero(overlap_.n_nodes(), dim);
  if (is_far_step(step)) // impulse over m steps (r-RESPA)
    add_impulse(parameters_.step_ratio, force);
  (fast_ ? fast_ : coarse_)->subtract_only_forces(near_.displacement(), force);
}

template <int dim>
auto FineScaleSplit<dim>::halfway(const Bodies<dim> &bodies, const StepTime &step) const -> Halfway
{
  const int m = parameters_.step_ratio;
  Halfway near;
  if (rests_) { // held: what pulls at it moves nothing
    near.velocity = near.force = near.acceleration = near.far_force = near.far_acceleration =
        Nodal<dim>::Zero(overlap_.n_nodes(), dim);
    return near;
  }
  compute_mesh_force(step, near.force);
  fine_.add_forces(bodies.zone->state, near.force);
  near.acceleration = near.force;
  mass_solver_->solve(near.acceleration.data(), dim);
  near.velocity = near_.velocity() + step.dt / 2 * near.acceleration;
  if (m == 1)
    return near;
  near.far_force.setZero(overlap_.n_nodes(), dim);
  add_impulse(1, near.far_force);
  near.far_acceleration = near.far_force;
  mass_solver_->solve(near.far_acceleration.data(), dim);
  near.force -= (m - 1) * near.far_force;
  near.acceleration -= (m - 1) * near.far_acceleration;
  return near;
}

template <int dim>
double FineScaleSplit<dim>::impulse_energy(const Bodies<dim> &bodies, const Halfway &near,
                                           double dt) const
{
  const int m = parameters_.step_ratio;
  if (m == 1)
    return 0;
  const auto &far = *bodies.far;
  Components<dim> v = far.halfway_velocity(m * dt);
  near_.write(near.velocity, v);
  far.follow_masters(v);
  // The kinetic energy of the far nodes lacks (m dt)^2/8 F M^-1 F already, not dt^2/8: 1/8 - 1/24.
  const Nodal<dim> a = 2 * near.acceleration - near.far_acceleration;
  return (m * m - 1) * dt * dt / 24 *
         (4 * far.quadratic_form(v) + 4 * slow_quadratic_form(near.velocity, m * dt) +
          2 * far.squared_force() - near.far_force.cwiseProduct(a).sum());
}

// By the forces a little later: they are dear, and those of now are known.
template <int dim>
double FineScaleSplit<dim>::slow_quadratic_form(const Nodal<dim> &v, double dt) const
{
  if (!fast_)
    return 0;
  const Nodal<dim> change = slow_force_at(near_.displacement() + dt * v) - slow_force_;
  return -0.5 * v.cwiseProduct(change).sum() / dt;
}

template <int dim>
double FineScaleSplit<dim>::damp_coarse_before_kick(double dt, double factor)
{
  const int m = parameters_.step_ratio;
  swing_.setZero(overlap_.n_nodes(), dim);
  undamped_ = swing_;
  if (rests_)
    return 0;
  if (m > 1) {
    add_impulse((m - 1) * dt / 2, swing_);
    mass_solver_->solve(swing_.data(), dim);
  }
  undamped_ = near_.velocity() + swing_;
  near_.set_velocity(factor * undamped_ - swing_);
  // The rest of it waits for the forces of the kick.
  return (1 - factor * factor) / 2 * undamped_.cwiseProduct(Nodal<dim>(mass_ * undamped_)).sum();
}

template <int dim>
double FineScaleSplit<dim>::damp_coarse_after_kick(double dt, double factor)
{
  if (rests_)
    return 0;
  const int m = parameters_.step_ratio;
  Nodal<dim> force = force_; // near forces and the far field's, without its factor m
  if (m > 1)
    add_impulse(1 - m, force);
  const Nodal<dim> mean = near_.velocity() - swing_;
  near_.set_velocity(factor * mean + swing_);
  const double still = mean.cwiseProduct(Nodal<dim>(mass_ * mean)).sum();
  return (1 - factor) / 2 *
         ((1 + factor) * still + dt * (undamped_ - mean).cwiseProduct(force).sum());
}

// theory.md eq. (E5b)
template <int dim>
double FineScaleSplit<dim>::damped_impulse_energy(const Bodies<dim> &bodies, double dt,
                                                  double factor) const
{
  const int m = parameters_.step_ratio;
  if (m == 1)
    return 0;
  const auto &far = *bodies.far;
  Components<dim> v = far.velocity;
  const Nodal<dim> mean = near_.velocity() - swing_;
  near_.write(mean, v);
  far.follow_masters(v);
  return (1 - std::pow(factor, 4)) * (m * m - 1) * dt * dt / 6 *
         (far.quadratic_form(v) + slow_quadratic_form(mean, m * dt));
}

// The rest of the class is instantiated in its own file.
template void FineScaleSplit<2>::add_impulse(double, Nodal<2> &) const;
template Nodal<2> FineScaleSplit<2>::slow_force_at(const Nodal<2> &) const;
template void FineScaleSplit<2>::compute_mesh_force(const StepTime &, Nodal<2> &) const;
template FineScaleSplit<2>::Halfway FineScaleSplit<2>::halfway(const Bodies<2> &,
                                                               const StepTime &) const;
template double FineScaleSplit<2>::impulse_energy(const Bodies<2> &, const Halfway &, double) const;
template double FineScaleSplit<2>::damp_coarse_before_kick(double, double);
template double FineScaleSplit<2>::damp_coarse_after_kick(double, double);
template double FineScaleSplit<2>::damped_impulse_energy(const Bodies<2> &, double, double) const;
template void FineScaleSplit<3>::add_impulse(double, Nodal<3> &) const;
template Nodal<3> FineScaleSplit<3>::slow_force_at(const Nodal<3> &) const;
template void FineScaleSplit<3>::compute_mesh_force(const StepTime &, Nodal<3> &) const;
template FineScaleSplit<3>::Halfway FineScaleSplit<3>::halfway(const Bodies<3> &,
                                                               const StepTime &) const;
template double FineScaleSplit<3>::impulse_energy(const Bodies<3> &, const Halfway &, double) const;
template double FineScaleSplit<3>::damp_coarse_before_kick(double, double);
template double FineScaleSplit<3>::damp_coarse_after_kick(double, double);
template double FineScaleSplit<3>::damped_impulse_energy(const Bodies<3> &, double, double) const;
} // namespace ligament::coupling
