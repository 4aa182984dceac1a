#include "particles/particle_force.h"

#include <algorithm>

namespace ligament::particles
{
template <int dim>
void ParticleForce<dim>::reference_forces(const Particles<dim> &particles,
                                          Components<dim> &force) const
{
  for (auto &component : force)
    component.assign(particles.size(), 0.);
}

template <int dim>
void ParticleForce<dim>::for_each_neighbour(const Particles<dim> &particles,
                                            const std::function<void(const Neighbour &)> &visit,
                                            const std::vector<int> *of) const
{
  for_each_face(
      particles,
      [&](const FaceView<dim> &face) {
        if (face.j >= 0)
          visit({face.i, face.j, face.bonded});
      },
      of);
}

template <int dim>
std::vector<int> ParticleForce<dim>::open_particles(const Particles<dim> &particles,
                                                    const std::vector<int> &of) const
{
  std::vector<Vector<dim>> closure(of.size(), Vector<dim>::Zero());
  std::vector<double> surface(of.size(), 0.);
  for_each_face(
      particles,
      [&](const FaceView<dim> &face) {
        const auto k = std::lower_bound(of.begin(), of.end(), face.i) - of.begin();
        closure[k] += face.area * face.normal;
        surface[k] += face.area;
      },
      &of);
  std::vector<int> open;
  // A cell that lacks a sliver of a face is open: its strain is wrong by the sliver's share.
  for (std::size_t k = 0; k < of.size(); ++k)
    if (closure[k].norm() > 1e-12 * surface[k])
      open.push_back(of[k]);
  return open;
}

template class ParticleForce<2>;
template class ParticleForce<3>;
} // namespace ligament::particles
