#include "coupling/operators/energy_weights.h"

#include "core/check.h"

#include <algorithm>

namespace ligament::coupling
{
template <int dim>
std::vector<double> mean_weights(const Overlap<dim> &overlap,
                                 const particles::Particles<dim> &particles,
                                 const particles::ParticleForce<dim> &force)
{
  const int n = particles.size();
  constexpr double centroid = dim / (dim + 1.); // of a pyramid, from its apex
  // Sums over pyramids of volume times 1 - a; particles beyond the overlap keep exactly 0.
  std::vector<double> rest(n, 0.), volume(n, 0.);
  std::vector<Vector<dim>> open(n, Vector<dim>::Zero()); // minus the area vector of all faces
  const std::vector<int> members = overlap.member_particles();
  force.for_each_face(
      particles,
      [&](const particles::FaceView<dim> &face) {
        const int i = face.i;
        const Vector<dim> x = get(particles.reference, i);
        const Vector<dim> lever = overlap.offset(x, face.centroid);
        const double pyramid = face.area * lever.dot(face.normal) / dim;
        volume[i] += pyramid;
        open[i] -= face.area * face.normal;
        rest[i] += pyramid * (1 - overlap.weight(x + centroid * lever));
      },
      &members);
  std::vector<double> weights(n, 1.);
  for (const auto &m : overlap.members) {
    const int i = m.particle;
    core::require(volume[i] > 0, "/coupling/scheme: the particles' energies are shared by their "
                                 "cells, which this force doesn't have; choose "
                                 "\"fine_scale_split\"");
    const double missing = particles.volume[i] - volume[i];
    if (missing > 1e-8 * particles.volume[i] && open[i].norm() > 0) {
      const Vector<dim> lever = overlap.parameters.spacing / 2 * open[i].normalized();
      rest[i] += missing * (1 - overlap.weight(get(particles.reference, i) + centroid * lever));
    }
    weights[i] = 1 - rest[i] / particles.volume[i];
    core::require(weights[i] > 0, "a particle at the edge of the packing has no energy of its own "
                                  "in the overlap: the zone's edge cuts the packing badly");
  }
  return weights;
}

template <int dim>
std::vector<double> weigh_members(const Overlap<dim> &overlap, const Transfer<dim> &transfer,
                                  particles::Particles<dim> &particles,
                                  particles::ParticleForce<dim> &force)
{
  const std::vector<double> weights = mean_weights(overlap, particles, force);
  force.set_energy_weights(weights);
  std::vector<double> shares;
  for (int k = 0; k < transfer.size(); ++k) {
    const int i = transfer.particle(k);
    shares.push_back(weights[i]);
    particles.mass[i] *= weights[i];
  }
  return shares;
}

template std::vector<double> mean_weights(const Overlap<2> &, const particles::Particles<2> &,
                                          const particles::ParticleForce<2> &);
template std::vector<double> mean_weights(const Overlap<3> &, const particles::Particles<3> &,
                                          const particles::ParticleForce<3> &);
template std::vector<double> weigh_members(const Overlap<2> &, const Transfer<2> &,
                                           particles::Particles<2> &,
                                           particles::ParticleForce<2> &);
template std::vector<double> weigh_members(const Overlap<3> &, const Transfer<3> &,
                                           particles::Particles<3> &,
                                           particles::ParticleForce<3> &);
} // namespace ligament::coupling
