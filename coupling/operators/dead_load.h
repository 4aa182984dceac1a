// What bonds that bear forces in the reference leave where a packing ends.
#pragma once

#include "coupling/overlap.h"

namespace ligament::coupling
{
/// g = Phi^T f(X) on the near nodes in N (theory.md eq. (C26)): the particles at the edge of the
/// packing are pulled by bonds whose other halves are missing, while the mesh stands for a body at
/// rest.
template <int dim>
Nodal<dim> make_dead_load(const Overlap<dim> &overlap, const particles::Particles<dim> &particles,
                          const particles::ParticleForce<dim> &force);
} // namespace ligament::coupling
