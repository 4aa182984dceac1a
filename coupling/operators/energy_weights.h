// How much of each particle belongs to the discrete model where energies and masses are blended.
#pragma once

#include "coupling/operators/transfer.h"

namespace ligament::coupling
{
/// Per owned particle the mean of a over its cell: 1 beyond the overlap, above 0 in it. The cell is
/// taken as pyramids over its faces, a at the centroid of each; what faces at the edge of the
/// packing lack of the volume counts as one more pyramid, half a spacing high.
template <int dim>
std::vector<double> mean_weights(const Overlap<dim> &overlap,
                                 const particles::Particles<dim> &particles,
                                 const particles::ParticleForce<dim> &force);

/// Weighs masses, inertias and energies by these. Returns the weights of the members in the
/// transfer's order.
template <int dim>
std::vector<double> weigh_members(const Overlap<dim> &overlap, const Transfer<dim> &transfer,
                                  particles::Particles<dim> &particles,
                                  particles::ParticleForce<dim> &force);
} // namespace ligament::coupling
