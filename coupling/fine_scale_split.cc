#include "coupling/fine_scale_split.h"

#include "core/check.h"

#include <fmt/format.h>

#include "coupling/gap_filter.h"

#include <cmath>

namespace ligament::coupling
{
template <int dim>
FineScaleSplit<dim>::FineScaleSplit(Bodies<dim> &bodies, const OverlapParameters &overlap,
                                    const FineScaleSplitParameters &parameters, double dt,
                                    core::Timers &timers)
    : Coupler<dim>(timers), parameters_(parameters),
      overlap_(bodies.zone->state, *bodies.zone->force, bodies.far->mesh(), overlap),
      projector_(overlap_, bodies.zone->state, parameters.solver),
      mass_solver_(make_linear_solver(parameters.solver))
{
  auto &far = *bodies.far;
  const auto operators =
      make_blended_operators(overlap_, bodies.zone->state, *bodies.zone->force, far.body());
  stiffness_ = operators.stiffness;
  if (parameters.patch_fit)
  {
    const PatchFit fit = fit_patch(overlap_, operators, far.body());
    stiffness_ += fit.correction;
    report_.patch_residual_before = fit.residual_before;
    report_.patch_residual = fit.residual;
    report_.patch_modulus = fit.largest_modulus;
    core::require(fit.residual < 1e-10,
                  fmt::format("the patch fit leaves a residual of {:.1e} (of C11 h^(dim-1)): the "
                              "overlap's shape is not supported; widen /coupling/overlap_cells or "
                              "keep the overlap away from corners, holes and loads",
                              fit.residual));
  }

  std::vector<int> released;
  for (const auto &cell : overlap_.cells)
    released.push_back(cell.cell);
  far.release_cells(released);
  mass_ = operators.mass;
  std::vector<Eigen::Triplet<double>> far_mass;
  for (int i = 0; i < overlap_.n_nodes(); ++i)
  {
    far_mass.emplace_back(i, i, far.lumped_mass()[overlap_.near_nodes[i]]);
    for (int c = 0; c < dim; ++c)
      core::require(!far.is_held(overlap_.near_nodes[i], c),
                    "the overlap or its transition reaches a held side of the specimen; keep the "
                    "zone away from it or lower /coupling/transition_cells");
  }
  Eigen::SparseMatrix<double> far_part(overlap_.n_nodes(), overlap_.n_nodes());
  far_part.setFromTriplets(far_mass.begin(), far_mass.end());
  mass_ += far_part;
  mass_solver_->factorise(mass_);

  const auto constants = bodies.zone->force->elastic_constants();
  if (parameters.gap_filter > 0)
    filter_ = make_gap_filter(overlap_, parameters.gap_filter, constants.wave_speed_p, dt,
                              operators.mass_bound);
  for (const int i : projector_.free_members())
  {
    const double s = overlap_.members[i].position;
    const double rate =
        parameters.fine_damper * constants.wave_speed_p / overlap_.cell_size * (1 - s) * (1 - s);
    damping_.push_back(1 - std::exp(-rate * dt));
  }
  displacement_ = Eigen::MatrixXd::Zero(overlap_.n_nodes(), dim);
  velocity_ = displacement_;
  for (auto &w : fluctuation_)
    w.assign(projector_.free_members().size(), 0.);

  report_.overlap_particles = int(overlap_.members.size());
  report_.pad_particles = report_.overlap_particles - int(projector_.free_members().size());
  report_.near_nodes = overlap_.n_nodes();
  take_velocities(bodies);
}

template <int dim>
void FineScaleSplit<dim>::take_velocities(Bodies<dim> &bodies)
{
  const auto &far = *bodies.far;
  const auto &zone = bodies.zone->state;
  for (int i = 0; i < overlap_.n_nodes(); ++i)
    for (int c = 0; c < dim; ++c)
    {
      displacement_(i, c) = far.displacement[c][overlap_.near_nodes[i]];
      velocity_(i, c) = far.velocity[c][overlap_.near_nodes[i]];
    }
  const auto &free = projector_.free_members();
  for (std::size_t k = 0; k < free.size(); ++k)
  {
    const auto &m = overlap_.members[free[k]];
    set(fluctuation_, int(k), Vector<dim>(get(zone.velocity, m.particle) -
                                          overlap_.interpolate(m, velocity_)));
  }
  projector_.project(fluctuation_);
  write_velocities(bodies);
}

// v = Phi V + w in the overlap; pads move and turn with the mesh.
template <int dim>
void FineScaleSplit<dim>::write_velocities(Bodies<dim> &bodies)
{
  auto &zone = bodies.zone->state;
  for (const auto &m : overlap_.members)
  {
    set(zone.velocity, m.particle, overlap_.interpolate(m, velocity_));
    if (m.pad)
      set(zone.spin, m.particle, overlap_.interpolate_spin(m, velocity_));
  }
  const auto &free = projector_.free_members();
  for (int c = 0; c < dim; ++c)
    for (std::size_t k = 0; k < free.size(); ++k)
      zone.velocity[c][overlap_.members[free[k]].particle] += fluctuation_[c][k];
  auto &far = *bodies.far;
  for (int c = 0; c < dim; ++c)
    for (int i = 0; i < overlap_.n_nodes(); ++i)
      far.velocity[c][overlap_.near_nodes[i]] = velocity_(i, c);
}

template <int dim>
void FineScaleSplit<dim>::drift(Bodies<dim> &bodies, const StepTime &step)
{
  {
    const auto timing = this->timers_.scope(this->motion_);
    bodies.zone->drift(step.dt);
    bodies.zone->update_ghosts();
  }
  displacement_ += step.dt * velocity_;
  // The far field moves in one go, just before it acts again: it is needed nowhere in between.
  if ((step.step + 1) % parameters_.step_ratio == 0)
  {
    const auto timing = this->timers_.scope(this->far_);
    auto &far = *bodies.far;
    for (int c = 0; c < dim; ++c)
      for (int i = 0; i < overlap_.n_nodes(); ++i)
        far.displacement[c][overlap_.near_nodes[i]] = displacement_(i, c);
    far.drift(parameters_.step_ratio * step.dt);
  }
}

template <int dim>
void FineScaleSplit<dim>::compute_forces(Bodies<dim> &bodies, const StepTime &step)
{
  {
    const auto timing = this->timers_.scope(this->forces_);
    bodies.zone->compute_forces(step.time);
  }
  if (is_far_step(step))
  {
    const auto timing = this->timers_.scope(this->far_);
    bodies.far->compute_forces(step.time);
  }
}

template <int dim>
Eigen::MatrixXd FineScaleSplit<dim>::near_force(const Bodies<dim> &bodies) const
{
  const int n = overlap_.n_nodes();
  Eigen::MatrixXd force(n, dim);
  Eigen::Map<Eigen::VectorXd>(force.data(), dim * n) =
      -(stiffness_ * Eigen::Map<const Eigen::VectorXd>(displacement_.data(), dim * n));
  const auto &zone = bodies.zone->state;
  for (const auto &m : overlap_.members)
  {
    const Vector<dim> f = get(zone.force, m.particle);
    for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
      for (int c = 0; c < dim; ++c)
        force(m.nodes[a], c) += m.value[a] * f[c];
    if (m.pad)
    {
      const Spin<dim> torque = get(zone.torque, m.particle);
      for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
        force.row(m.nodes[a]) += torque.transpose() * Overlap<dim>::spin_block(m, a);
    }
  }
  return force;
}

template <int dim>
Eigen::MatrixXd FineScaleSplit<dim>::far_force(const Bodies<dim> &bodies) const
{
  Eigen::MatrixXd force(overlap_.n_nodes(), dim);
  for (int c = 0; c < dim; ++c)
    for (int i = 0; i < overlap_.n_nodes(); ++i)
      force(i, c) = bodies.far->force[c][overlap_.near_nodes[i]];
  return force;
}

template <int dim>
double FineScaleSplit<dim>::coarse_kinetic(const Eigen::MatrixXd &force, double dt) const
{
  return 0.5 * velocity_.cwiseProduct(mass_ * velocity_ + dt * force).sum();
}

template <int dim>
double FineScaleSplit<dim>::fine_kinetic(const Bodies<dim> &bodies, double dt) const
{
  const auto &zone = bodies.zone->state;
  double sum = 0;
  const auto &free = projector_.free_members();
  for (int c = 0; c < dim; ++c)
    for (std::size_t k = 0; k < free.size(); ++k)
    {
      const int i = overlap_.members[free[k]].particle;
      sum += fluctuation_[c][k] * (zone.mass[i] * fluctuation_[c][k] + dt * zone.force[c][i]);
    }
  for (int i = 0; i < zone.n_owned; ++i)
  {
    const int index = overlap_.member_of_particle[i];
    if (index < 0)
      for (int c = 0; c < dim; ++c)
        sum += zone.velocity[c][i] * (zone.mass[i] * zone.velocity[c][i] + dt * zone.force[c][i]);
    if (index < 0 || !overlap_.members[index].pad)
      for (int c = 0; c < n_spins<dim>; ++c)
        sum += zone.spin[c][i] * (zone.inertia[i] * zone.spin[c][i] + dt * zone.torque[c][i]);
  }
  return sum / 2;
}

template <int dim>
void FineScaleSplit<dim>::kick(Bodies<dim> &bodies, const StepTime &step)
{
  if (is_far_step(step))
  {
    const auto timing = this->timers_.scope(this->far_);
    bodies.far->kick(parameters_.step_ratio * step.dt, step.time);
  }
  {
    const auto timing = this->timers_.scope(this->motion_);
    bodies.zone->kick(step.dt);
  }
  const auto timing = this->timers_.scope(this->coupling_);
  kick_coarse(bodies, step);
  kick_fine(bodies, step);
  write_velocities(bodies);
}

// V += dt M_c^-1 F, then the gap-band filter.
template <int dim>
void FineScaleSplit<dim>::kick_coarse(const Bodies<dim> &bodies, const StepTime &step)
{
  force_ = near_force(bodies);
  if (is_far_step(step)) // impulse over m steps (r-RESPA) on the border with the far field
    force_ += parameters_.step_ratio * far_force(bodies);
  Eigen::MatrixXd change = step.dt * force_;
  mass_solver_->solve(change);
  velocity_ += change;
  if (filter_.rows() == 0)
    return;
  const Eigen::MatrixXd momentum = filter_ * velocity_;
  change = momentum;
  mass_solver_->solve(change);
  // Kinetic energy before and after, and the work that the force no longer does on the way to the
  // next position (theory.md eq. (E3)).
  gap_filter_energy_ += momentum.cwiseProduct(velocity_).sum() -
                        0.5 * momentum.cwiseProduct(change).sum() -
                        0.5 * step.dt * force_.cwiseProduct(change).sum();
  velocity_ -= change;
}

// w += dt Q f/m, then the fluctuation damper between two projections.
template <int dim>
void FineScaleSplit<dim>::kick_fine(const Bodies<dim> &bodies, const StepTime &step)
{
  const auto &zone = bodies.zone->state;
  const auto &free = projector_.free_members();
  for (int c = 0; c < dim; ++c)
    for (std::size_t k = 0; k < free.size(); ++k)
    {
      const int i = overlap_.members[free[k]].particle;
      fluctuation_[c][k] += step.dt * zone.force[c][i] * zone.inverse_mass[i];
    }
  projector_.project(fluctuation_);
  if (parameters_.fine_damper == 0)
    return;
  undamped_ = fluctuation_;
  for (int c = 0; c < dim; ++c)
    for (std::size_t k = 0; k < free.size(); ++k)
      fluctuation_[c][k] -= damping_[k] * fluctuation_[c][k];
  projector_.project(fluctuation_);
  for (int c = 0; c < dim; ++c)
    for (std::size_t k = 0; k < free.size(); ++k)
    {
      const int i = overlap_.members[free[k]].particle;
      const double v0 = undamped_[c][k], v1 = fluctuation_[c][k];
      fine_damper_energy_ +=
          0.5 * (v0 - v1) * (zone.mass[i] * (v0 + v1) - step.dt * zone.force[c][i]);
    }
}

template <int dim>
double FineScaleSplit<dim>::scale_velocities(Bodies<dim> &bodies, const StepTime &step,
                                             double factor)
{
  const auto timing = this->timers_.scope(this->coupling_);
  double loss = scaling_loss(fine_kinetic(bodies, 0), fine_kinetic(bodies, step.dt), factor) +
                scaling_loss(coarse_kinetic(force_, 0), coarse_kinetic(force_, step.dt), factor);
  bodies.zone->scale_velocities(factor);
  for (auto &w : fluctuation_)
    for (double &v : w)
      v *= factor;
  velocity_ *= factor;
  if (is_far_step(step))
  {
    // The far field keeps its velocities for m steps: it takes their damping at once.
    auto &far = *bodies.far;
    const double whole = std::pow(factor, parameters_.step_ratio);
    loss += scaling_loss(far.kinetic_energy(0),
                         far.kinetic_energy(parameters_.step_ratio * step.dt), whole);
    far.scale_velocities(whole);
  }
  write_velocities(bodies);
  return loss;
}

template <int dim>
CoupledEnergy FineScaleSplit<dim>::energy(const Bodies<dim> &bodies, const StepTime &step) const
{
  CoupledEnergy e;
  e.fine_damper = fine_damper_energy_;
  e.gap_filter = gap_filter_energy_;
  e.potential_discrete = bodies.zone->potential_energy();
  e.potential_far = bodies.far->potential_energy();
  const Eigen::Map<const Eigen::VectorXd> u(displacement_.data(), displacement_.size());
  e.blended = 0.5 * u.dot(stiffness_ * u);
  Eigen::MatrixXd force = near_force(bodies);
  if (is_far_step(step))
    force += parameters_.step_ratio * far_force(bodies);
  e.kinetic_far = bodies.far->kinetic_energy(parameters_.step_ratio * step.dt) +
                  coarse_kinetic(force, step.dt);
  e.kinetic_discrete = fine_kinetic(bodies, step.dt);
  return e;
}

template class FineScaleSplit<2>;
template class FineScaleSplit<3>;
} // namespace ligament::coupling
