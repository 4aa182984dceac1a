// Static equilibrium of the linearised body: some particles are held at a given motion, the others
// come to rest under given loads.
#pragma once

#include "particles/particle_force.h"

namespace ligament::particles
{
/// Solves for the free particles so that no force and torque is left on them (theory.md eq. (D1)
/// and (D2) at rest, linearised about the reference). `motion` holds displacement (m), then
/// rotation vector (rad), of particle after particle: n_particle_dofs<dim> each. Those of held
/// particles are taken as they are, those of free ones overwritten. `load` holds what acts on them
/// besides, force (N) and torque (N m) in the same order; empty: nothing. Throws
/// core::EnvironmentError when the stiffness cannot be factorised.
template <int dim>
void solve_equilibrium(const Particles<dim> &particles, const ParticleForce<dim> &force,
                       const std::vector<char> &is_free, Eigen::VectorXd &motion,
                       const Eigen::VectorXd &load = {});
} // namespace ligament::particles
