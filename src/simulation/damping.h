// Damping of the whole body for quasi-static loading, with the energy that it takes.
#pragma once

#include "core/state.h"
#include "src/simulation/coupled_body.h"

namespace ligament::program
{
/// Local: a force of the given fraction of each force component, against its velocity. Mass:
/// velocities decay at the given rate. Kinetic: velocities vanish at peaks of the kinetic energy.
template <int dim>
class BodyDamping
{
public:
  explicit BodyDamping(const Damping &parameters) : parameters_(parameters) {}

  /// Between forces and kick.
  void before_kick(CoupledBody<dim> &body, const coupling::StepTime &step);
  /// Between kick and drift.
  void after_kick(CoupledBody<dim> &body, const coupling::StepTime &step);

  /// J, so far. Each step books numbers that are exact sums over the particles.
  double energy() const { return energy_; }

  /// Between drift and forces.
  void save(core::State &state) const;
  void load(const core::State &state);

private:
  void add_local_forces(CoupledBody<dim> &body, double dt, bool far_acts);
  double local_power(const CoupledBody<dim> &body) const;
  /// Mass damping of half the step; before the kick, with the sign of dt changed after it. Returns
  /// the energy in J that it takes.
  double damp_half_a_step(CoupledBody<dim> &body, const coupling::StepTime &step);

  Damping parameters_;
  double energy_ = 0;
  double last_kinetic_ = 0;
  bool restarts_ = false;                  // from rest, in this step
  std::vector<double> inverse_far_mass_;   // 1/kg, own cells of the far field
  Components<dim> zone_force_, far_force_; // N, of local damping
  Components<n_spins<dim>> zone_torque_;   // N m
};
} // namespace ligament::program
