// The body at rest as the default coupler joins it: for a solver that seeks equilibrium.
#include "coupling/fine_scale_split.h"

namespace ligament::coupling
{
template <int dim>
void FineScaleSplit<dim>::expand(particles::Particles<dim> &zone, Components<dim> &nodal) const
{
  fine_.expand(near_.of(nodal), zone);
}

template <int dim>
void FineScaleSplit<dim>::restrict_forces(particles::Particles<dim> &zone,
                                          Components<dim> &nodal) const
{
  Nodal<dim> force = near_.of(nodal);
  fine_.restrict_forces(zone, force);
  near_.write(force, nodal);
}

template <int dim>
void FineScaleSplit<dim>::compute_trial(Bodies<dim> &bodies, double time, double noted_share,
                                        Components<dim> &nodal_force) const
{
  Coupler<dim>::compute_trial(bodies, time, noted_share, nodal_force);
  Nodal<dim> force = near_.of(nodal_force);
  coarse_->subtract_only_forces(near_.displacement(), force);
  near_.write(force, nodal_force);
}

template <int dim>
void FineScaleSplit<dim>::subtract_near_stiffness(const Components<dim> &u,
                                                  Components<dim> &nodal_force) const
{
  Nodal<dim> force = near_.of(nodal_force);
  linear_->subtract_forces(near_.of(u), force);
  near_.write(force, nodal_force);
}

template <int dim>
void FineScaleSplit<dim>::follow(Bodies<dim> &bodies)
{
  if (regime_ != Regime::linear)
    fine_.turn_pads(near_.displacement(), bodies.zone->state);
}

// Just before an impulse of the far field V is behind its mean by what the near forces have taken
// back since the last one.
template <int dim>
void FineScaleSplit<dim>::start_velocities(Bodies<dim> &bodies, const StepTime &step)
{
  const int m = parameters_.step_ratio;
  if (m > 1) {
    if (fast_)
      slow_force_ = slow_force_at(near_.displacement());
    Nodal<dim> swing = Nodal<dim>::Zero(overlap_.n_nodes(), dim);
    add_impulse(-(m - 1) * step.dt / 2, swing);
    mass_solver_->solve(swing.data(), dim);
    near_.add_velocity(1, swing);
  }
  take_velocities(bodies);
}

// What acts on the members reaches the nodes through Phi^T: the nodes get what is left of M_c.
template <int dim>
std::vector<double>
FineScaleSplit<dim>::near_weight(const particles::Particles<dim> &particles) const
{
  Eigen::VectorXd weight = mass_ * Eigen::VectorXd::Ones(overlap_.n_nodes());
  for (const auto &member : overlap_.members)
    for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
      weight[member.nodes[a]] -= member.value[a] * particles.mass[member.particle];
  return {weight.begin(), weight.end()};
}

template std::vector<double> FineScaleSplit<2>::near_weight(const particles::Particles<2> &) const;
template std::vector<double> FineScaleSplit<3>::near_weight(const particles::Particles<3> &) const;
// The rest of the class is instantiated in its own file.
template void FineScaleSplit<2>::expand(particles::Particles<2> &, Components<2> &) const;
template void FineScaleSplit<3>::expand(particles::Particles<3> &, Components<3> &) const;
template void FineScaleSplit<2>::restrict_forces(particles::Particles<2> &, Components<2> &) const;
template void FineScaleSplit<3>::restrict_forces(particles::Particles<3> &, Components<3> &) const;
template void FineScaleSplit<2>::compute_trial(Bodies<2> &, double, double, Components<2> &) const;
template void FineScaleSplit<3>::compute_trial(Bodies<3> &, double, double, Components<3> &) const;
template void FineScaleSplit<2>::subtract_near_stiffness(const Components<2> &,
                                                         Components<2> &) const;
template void FineScaleSplit<3>::subtract_near_stiffness(const Components<3> &,
                                                         Components<3> &) const;
template void FineScaleSplit<2>::follow(Bodies<2> &);
template void FineScaleSplit<3>::follow(Bodies<3> &);
template void FineScaleSplit<2>::start_velocities(Bodies<2> &, const StepTime &);
template void FineScaleSplit<3>::start_velocities(Bodies<3> &, const StepTime &);
} // namespace ligament::coupling
