#include "coupling/bridging_domain.h"

#include "coupling/operators/blended_operators.h"
#include "coupling/operators/energy_weights.h"
#include "coupling/operators/fine_damper.h"

#include <algorithm>
#include <cmath>

namespace ligament::coupling
{
namespace
{
/// No scheme has pads; row sums are those of a lumped mass.
template <int dim>
OverlapParameters<dim> adapted(OverlapParameters<dim> parameters, Scheme scheme)
{
  parameters.has_pads = false;
  parameters.lumps_mass = scheme == Scheme::xiao_belytschko_lumped;
  return parameters;
}
} // namespace

template <int dim>
BridgingDomain<dim>::BridgingDomain(Bodies<dim> &bodies, OverlapParameters<dim> overlap,
                                    const BridgingDomainParameters &parameters,
                                    core::Timers &timers)
    : Coupler<dim>(timers), parameters_(parameters),
      overlap_(bodies.zone->state, *bodies.zone->force, bodies.far->mesh(),
               adapted(std::move(overlap), parameters.scheme)),
      near_(*bodies.far, overlap_.near_nodes), transfer_(overlap_, bodies.zone->state),
      shares_(weigh_members(overlap_, transfer_, bodies.zone->state, *bodies.zone->force)),
      weighted_transfer_(overlap_, bodies.zone->state),
      projector_(overlap_,
                 parameters.damper_form == DamperForm::printed ? transfer_ : weighted_transfer_,
                 parameters.solver),
      mass_solver_(make_linear_solver(parameters.solver))
{
  auto &far = *bodies.far;
  const auto operators =
      make_cell_operators(overlap_, bodies.zone->state, *bodies.zone->force, far.body());
  stiffness_ = operators.stiffness;
  stiffness_blocks_ = std::make_unique<BlockMatrix<dim>>(stiffness_);
  mass_ = take_over_cells(overlap_, far) + operators.mass;
  mass_solver_->factorise(mass_);
  constraint_ = std::make_unique<VelocityConstraint<dim>>(
      parameters.scheme, overlap_, transfer_, shares_, mass_, parameters.multiplier_cells,
      parameters.solver);
  const double wave_speed = bodies.zone->force->elastic_constants().wave_speed_p;
  for (int k = 0; k < transfer_.size(); ++k)
    rate_.push_back(fine_damper_rate(parameters.fine_damper, wave_speed, overlap_.cell_size,
                                     transfer_.position(k)));
  for (auto &v : member_velocity_)
    v.resize(transfer_.size());
  lost_ = before_damper_ = member_velocity_;
  force_ = acceleration_ = dead_nodal_ = Nodal<dim>::Zero(overlap_.n_nodes(), dim);
  if (std::any_of(parameters.reference_strain.begin(), parameters.reference_strain.end(),
                  [](double e) { return e != 0; }))
    find_dead_load(bodies);
  bodies.zone->force->set_coupled_edge(bodies.zone->state, overlap_.coupled_edge(far.displacement));
  take_velocities(bodies);
}

// The forces and torques that a uniform strain would leave at the members, their neighbours and the
// near nodes, with the opposite sign. Nothing breaks, and no loads act: those are no dead load.
template <int dim>
void BridgingDomain<dim>::find_dead_load(Bodies<dim> &bodies)
{
  auto &zone = bodies.zone->state;
  auto &far = *bodies.far;
  const auto strained = [&](const Vector<dim> &x, int c) {
    return parameters_.reference_strain[c] * x[c];
  };
  const auto zone_before = zone.displacement;
  const auto far_before = far.displacement;
  for (int c = 0; c < dim; ++c) {
    for (int i = 0; i < zone.size(); ++i)
      zone.displacement[c][i] = strained(get(zone.reference, i), c);
    for (int i = 0; i < far.mesh().n_nodes(); ++i)
      far.displacement[c][i] = strained(far.mesh().nodes[i], c);
  }
  std::vector<char> is_near(zone.size(), 0);
  const std::vector<int> members = overlap_.member_particles();
  bodies.zone->force->for_each_face(
      zone,
      [&](const particles::FaceView<dim> &face) {
        is_near[face.i] = 1;
        if (face.j >= 0)
          is_near[face.j] = 1;
      },
      &members);
  Nodal<dim> strained_nodal, nodal;
  bodies.zone->force->compute_bonds(zone, false);
  far.compute_trial(0);
  compute_near_force(strained_nodal);
  dead_ = zone.force;
  dead_torque_ = zone.torque;
  const auto reverse = [&](auto &components) {
    for (auto &component : components)
      for (int i = 0; i < zone.size(); ++i)
        component[i] *= -is_near[i];
  };
  reverse(dead_);
  reverse(dead_torque_);
  zone.displacement = zone_before;
  far.displacement = far_before;
  bodies.zone->force->compute_bonds(zone, false);
  far.compute_trial(0);
  compute_near_force(nodal);
  dead_nodal_ = nodal - strained_nodal;
}

template <int dim>
double BridgingDomain<dim>::near_stable_step() const
{
  // Power iteration for the largest frequency from a motion that is smooth in no way.
  Nodal<dim> x(overlap_.n_nodes(), dim);
  for (int i = 0; i < x.rows(); ++i)
    for (int c = 0; c < dim; ++c)
      x(i, c) = std::sin(37. * i + 101. * c + 1);
  double square = 0;
  for (int k = 0; k < 60; ++k) {
    x /= std::sqrt(x.cwiseProduct(Nodal<dim>(mass_ * x)).sum());
    Nodal<dim> force = Nodal<dim>::Zero(x.rows(), dim);
    stiffness_blocks_->subtract_product(x, force);
    square = -x.cwiseProduct(force).sum();
    mass_solver_->solve(force.data(), dim);
    x = force;
  }
  return 2 / (1.05 * std::sqrt(square)); // it nears the frequency from below
}

template <int dim>
void BridgingDomain<dim>::take_velocities(Bodies<dim> &bodies)
{
  if (!corrects_at_whole_steps()) // these carry any
    project(bodies);
}

template <int dim>
void BridgingDomain<dim>::project(Bodies<dim> &bodies)
{
  auto &velocity = bodies.zone->state.velocity;
  transfer_.read(velocity, member_velocity_);
  Nodal<dim> nodal = near_.velocity();
  constraint_->project(member_velocity_, nodal);
  transfer_.write(member_velocity_, velocity);
  near_.set_velocity(nodal);
}

template <int dim>
void BridgingDomain<dim>::drift(Bodies<dim> &bodies, const StepTime &step)
{
  {
    const auto timing = this->timers_.scope(this->motion_);
    bodies.zone->drift(step.dt);
    bodies.zone->update_ghosts();
  }
  const auto timing = this->timers_.scope(this->far_);
  near_.drift(step.dt);
  bodies.far->drift(step.dt);
}

template <int dim>
void BridgingDomain<dim>::compute_forces(Bodies<dim> &bodies, const StepTime &step)
{
  {
    const auto timing = this->timers_.scope(this->forces_);
    bodies.zone->compute_forces(step.time);
    add_dead_load(bodies.zone->state);
  }
  const auto timing = this->timers_.scope(this->far_);
  bodies.far->compute_forces(step.time);
}

template <int dim>
void BridgingDomain<dim>::add_dead_load(particles::Particles<dim> &zone) const
{
  for (int c = 0; c < dim; ++c)
    for (std::size_t i = 0; i < dead_[c].size(); ++i)
      zone.force[c][i] += dead_[c][i];
  for (int c = 0; c < n_spins<dim>; ++c)
    for (std::size_t i = 0; i < dead_torque_[c].size(); ++i)
      zone.torque[c][i] += dead_torque_[c][i];
}

template <int dim>
void BridgingDomain<dim>::compute_near_force(Nodal<dim> &force) const
{
  force = dead_nodal_;
  near_.add_force(1, force);
  stiffness_blocks_->subtract_product(near_.displacement(), force);
}

template <int dim>
bool BridgingDomain<dim>::corrects_at_whole_steps() const
{
  return parameters_.scheme == Scheme::xiao_belytschko ||
         parameters_.scheme == Scheme::xiao_belytschko_lumped;
}

// Particles and near nodes by the forces alone.
template <int dim>
void BridgingDomain<dim>::push(Bodies<dim> &bodies, double dt)
{
  {
    const auto timing = this->timers_.scope(this->motion_);
    bodies.zone->kick(dt);
  }
  const auto timing = this->timers_.scope(this->coupling_);
  near_.add_velocity(dt, acceleration_);
}

template <int dim>
void BridgingDomain<dim>::kick(Bodies<dim> &bodies, const StepTime &step)
{
  {
    const auto timing = this->timers_.scope(this->coupling_);
    compute_near_force(force_);
    acceleration_ = force_;
    mass_solver_->solve(acceleration_.data(), dim);
  }
  {
    const auto timing = this->timers_.scope(this->far_);
    bodies.far->kick(step.dt, step.time);
  }
  const bool damps = parameters_.fine_damper > 0;
  if (damps && parameters_.damper_form == DamperForm::symmetrised) {
    move_and_damp(bodies, step.dt);
    return;
  }
  move(bodies, step.dt);
  if (damps) {
    transfer_.read(bodies.zone->state.velocity, before_damper_);
    damp(bodies, step.dt);
    book_damper(bodies);
  }
}

// Of `acceleration` one kick and one projection of all velocities: what is projected is the
// acceleration, because the velocities before fulfil the constraint. The schemes after Xiao and
// Belytschko move with the unconstrained acceleration and correct velocities at whole steps.
template <int dim>
void BridgingDomain<dim>::move(Bodies<dim> &bodies, double dt)
{
  const bool corrects = corrects_at_whole_steps();
  push(bodies, corrects ? dt / 2 : dt);
  project(bodies);
  if (corrects)
    push(bodies, dt / 2);
}

// The same, with the damper at whole steps, on velocities that the scheme carries: there it takes
// energy whatever the step (theory.md section 3.9).
template <int dim>
void BridgingDomain<dim>::move_and_damp(Bodies<dim> &bodies, double dt)
{
  const bool corrects = corrects_at_whole_steps();
  if (!corrects)
    transfer_.read(bodies.zone->state.velocity, before_damper_);
  push(bodies, dt / 2);
  if (corrects)
    transfer_.read(bodies.zone->state.velocity, before_damper_);
  else
    project(bodies);
  damp(bodies, dt);
  if (corrects) {
    book_damper(bodies);
    project(bodies);
    push(bodies, dt / 2);
  } else {
    push(bodies, dt / 2);
    project(bodies);
    book_damper(bodies);
  }
}

// v -= Q g Q v, or v -= g Q v as printed (theory.md eq. (B7)).
template <int dim>
void BridgingDomain<dim>::damp(Bodies<dim> &bodies, double dt)
{
  const auto timing = this->timers_.scope(this->coupling_);
  auto &zone = bodies.zone->state;
  transfer_.read(zone.velocity, lost_);
  projector_.project(lost_);
  for (auto &v : lost_)
    for (int k = 0; k < transfer_.size(); ++k)
      v[k] *= 1 - std::exp(-rate_[k] * dt);
  if (parameters_.damper_form == DamperForm::symmetrised)
    projector_.project(lost_);
  for (int c = 0; c < dim; ++c)
    for (int k = 0; k < transfer_.size(); ++k) {
      const int i = transfer_.particle(k);
      zone.velocity[c][i] -= lost_[c][k];
      lost_[c][k] *= zone.mass[i];
    }
}

// theory.md eq. (E3): with the velocities before and after the kick where what follows the damper
// is a projection, else with those before and after the damper.
template <int dim>
void BridgingDomain<dim>::book_damper(const Bodies<dim> &bodies)
{
  double sum = 0;
  for (int c = 0; c < dim; ++c)
    for (int k = 0; k < transfer_.size(); ++k)
      sum += lost_[c][k] *
             (before_damper_[c][k] + bodies.zone->state.velocity[c][transfer_.particle(k)]);
  fine_damper_energy_ += sum / 2;
}

template <int dim>
void BridgingDomain<dim>::scale_velocities(Bodies<dim> &bodies, double factor)
{
  bodies.zone->scale_velocities(factor);
  bodies.far->scale_velocities(factor);
}

template <int dim>
double BridgingDomain<dim>::damp_velocities(Bodies<dim> &bodies, const StepTime &step,
                                            double factor)
{
  const auto timing = this->timers_.scope(this->coupling_);
  const Nodal<dim> v = near_.velocity();
  const double still = 0.5 * v.cwiseProduct(Nodal<dim>(mass_ * v)).sum();
  if (step.dt > 0)
    compute_near_force(force_);
  const double moving = still + 0.5 * step.dt * v.cwiseProduct(force_).sum();
  const double loss = scaling_loss(still, moving, factor) +
                      bodies.zone->damp_velocities(factor, step.dt).value() +
                      bodies.far->damp_velocities(step.dt);
  near_.set_velocity(factor * v);
  return loss;
}

template <int dim>
CoupledEnergy BridgingDomain<dim>::energy(const Bodies<dim> &bodies, const StepTime &step) const
{
  CoupledEnergy e;
  e.fine_damper = fine_damper_energy_;
  e.potential_discrete = bodies.zone->potential_energy();
  e.potential_far = bodies.far->potential_energy();
  // The constraint's forces do no work on velocities that fulfil it.
  Nodal<dim> force;
  compute_near_force(force);
  e.kinetic_discrete = bodies.zone->kinetic_energy(step.dt);
  const Nodal<dim> &v = near_.velocity(), &u = near_.displacement();
  e.kinetic_far = bodies.far->kinetic_energy(step.dt) +
                  0.5 * v.cwiseProduct(Nodal<dim>(mass_ * v + step.dt * force)).sum();
  Nodal<dim> internal = Nodal<dim>::Zero(overlap_.n_nodes(), dim);
  stiffness_blocks_->subtract_product(u, internal);
  e.blended = -0.5 * u.cwiseProduct(internal).sum() - u.cwiseProduct(dead_nodal_).sum();
  for (int c = 0; c < dim; ++c)
    for (std::size_t i = 0; i < dead_[c].size(); ++i)
      e.blended -= dead_[c][i] * bodies.zone->state.displacement[c][i];
  // Small rotations; in 3D half of them is the vector part of the quaternion.
  const auto &rotation = bodies.zone->state.rotation;
  for (int c = 0; c < n_spins<dim>; ++c)
    for (std::size_t i = 0; i < dead_torque_[c].size(); ++i)
      e.blended -= dead_torque_[c][i] * (dim == 2 ? rotation[c][i] : 2 * rotation[c + 1][i]);
  return e;
}

template <int dim>
void BridgingDomain<dim>::save(core::State &state, const Bodies<dim> &) const
{
  core::save_value(state, "bridging_domain", "damper_energy", fine_damper_energy_);
}

template <int dim>
void BridgingDomain<dim>::load(const core::State &state, Bodies<dim> &)
{
  fine_damper_energy_ = core::load_real(state, "bridging_domain", "damper_energy");
}

template <int dim>
std::vector<core::SkippedPart> BridgingDomain<dim>::skipped_parts() const
{
  if (parameters_.fine_damper == 0)
    return {{"fluctuation damper", "/coupling/fine_damper is 0"}};
  return {};
}

template class BridgingDomain<2>;
template class BridgingDomain<3>;
} // namespace ligament::coupling
