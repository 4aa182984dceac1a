#include "coupling/operators/dead_load.h"

namespace ligament::coupling
{
template <int dim>
Nodal<dim> make_dead_load(const Overlap<dim> &overlap, const particles::Particles<dim> &particles,
                          const particles::ParticleForce<dim> &force)
{
  Components<dim> f;
  force.reference_forces(particles, f);
  Nodal<dim> load = Nodal<dim>::Zero(overlap.n_nodes(), dim);
  for (const auto &m : overlap.members)
    for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
      load.row(m.nodes[a]) += m.value[a] * get(f, m.particle).transpose();
  return load;
}

template Nodal<2> make_dead_load(const Overlap<2> &, const particles::Particles<2> &,
                                 const particles::ParticleForce<2> &);
template Nodal<3> make_dead_load(const Overlap<3> &, const particles::Particles<3> &,
                                 const particles::ParticleForce<3> &);
} // namespace ligament::coupling
