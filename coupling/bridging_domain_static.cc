// The body at rest as the couplers of the literature join it: for a solver that seeks equilibrium.
#include "coupling/bridging_domain.h"

namespace ligament::coupling
{
template <int dim>
void BridgingDomain<dim>::expand(particles::Particles<dim> &zone, Components<dim> &nodal) const
{
  Components<dim> members = member_velocity_;
  transfer_.read(zone.velocity, members);
  Nodal<dim> near = near_.of(nodal);
  constraint_->project(members, near);
  transfer_.write(members, zone.velocity);
  near_.write(near, nodal);
}

// The projection is symmetric in the masses.
template <int dim>
void BridgingDomain<dim>::restrict_forces(particles::Particles<dim> &zone,
                                          Components<dim> &nodal) const
{
  Components<dim> members = member_velocity_;
  transfer_.read(zone.force, members);
  const auto scale = [&](auto &&factor) {
    for (auto &values : members)
      for (int k = 0; k < transfer_.size(); ++k)
        values[k] *= factor(zone.mass[transfer_.particle(k)]);
  };
  Nodal<dim> near = near_.of(nodal);
  scale([](double mass) { return 1 / mass; });
  mass_solver_->solve(near.data(), dim);
  constraint_->project(members, near);
  scale([](double mass) { return mass; });
  transfer_.write(members, zone.force);
  near_.write(Nodal<dim>(mass_ * near), nodal);
}

template <int dim>
void BridgingDomain<dim>::compute_trial(Bodies<dim> &bodies, double time, double noted_share,
                                        Components<dim> &nodal_force) const
{
  Coupler<dim>::compute_trial(bodies, time, noted_share, nodal_force);
  add_dead_load(bodies.zone->state);
  Nodal<dim> force = near_.of(nodal_force) + dead_nodal_;
  stiffness_blocks_->subtract_product(near_.displacement(), force);
  near_.write(force, nodal_force);
}

template <int dim>
void BridgingDomain<dim>::subtract_near_stiffness(const Components<dim> &u,
                                                  Components<dim> &nodal_force) const
{
  Nodal<dim> force = near_.of(nodal_force);
  stiffness_blocks_->subtract_product(near_.of(u), force);
  near_.write(force, nodal_force);
}

// Particles and nodes share the mass by the weights, and each its own part of the force.
template <int dim>
std::vector<double> BridgingDomain<dim>::near_weight(const particles::Particles<dim> &) const
{
  const Eigen::VectorXd weight = mass_ * Eigen::VectorXd::Ones(overlap_.n_nodes());
  return {weight.begin(), weight.end()};
}

template std::vector<double> BridgingDomain<2>::near_weight(const particles::Particles<2> &) const;
template std::vector<double> BridgingDomain<3>::near_weight(const particles::Particles<3> &) const;
// The rest of the class is instantiated in its own file.
template void BridgingDomain<2>::expand(particles::Particles<2> &, Components<2> &) const;
template void BridgingDomain<3>::expand(particles::Particles<3> &, Components<3> &) const;
template void BridgingDomain<2>::restrict_forces(particles::Particles<2> &, Components<2> &) const;
template void BridgingDomain<3>::restrict_forces(particles::Particles<3> &, Components<3> &) const;
template void BridgingDomain<2>::compute_trial(Bodies<2> &, double, double, Components<2> &) const;
template void BridgingDomain<3>::compute_trial(Bodies<3> &, double, double, Components<3> &) const;
template void BridgingDomain<2>::subtract_near_stiffness(const Components<2> &,
                                                         Components<2> &) const;
template void BridgingDomain<3>::subtract_near_stiffness(const Components<3> &,
                                                         Components<3> &) const;
} // namespace ligament::coupling
