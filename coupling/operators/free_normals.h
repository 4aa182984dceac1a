// Free surfaces that the nodes of the overlap feel: the patch fit leaves such nodes out of the
// normal direction.
#pragma once

#include "coupling/overlap.h"
#include "particles/particle_force.h"

namespace ligament::coupling
{
/// Per near node the outward normals of the free surfaces that its residual feels: a particle at
/// such a surface, or a neighbour of one, hands it forces, or it lies on the surface itself, on a
/// side of the box, one with a name or one without. Throws core::InputError where the overlap ends
/// at a surface that no axis is normal to.
template <int dim>
std::vector<std::vector<Vector<dim>>> find_free_normals(const Overlap<dim> &overlap,
                                                        const particles::Particles<dim> &particles,
                                                        const particles::ParticleForce<dim> &force);
} // namespace ligament::coupling
