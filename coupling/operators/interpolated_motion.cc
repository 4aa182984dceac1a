#include "coupling/operators/interpolated_motion.h"

#include <Eigen/LU>

#include <cmath>

namespace ligament::coupling
{
namespace
{
// Part of the way that a particle goes to the middle of its neighbours (theory.md eq. (C17)).
constexpr double relaxation = 0.25;

template <int dim>
void add_share(InterpolatedMotion<dim> &motion, const NodeShare<dim> &share)
{
  for (NodeShare<dim> &s : motion)
    if (s.node == share.node) {
      s.value += share.value;
      s.gradient += share.gradient;
      return;
    }
  motion.push_back(share);
}
} // namespace

// Pads turn as they do in the step, by half the curl of their cell. The others turn by half the
// curl that they and their neighbours see (least squares): the curl of a cell jumps at its border,
// and a particle there would follow one side only; then shear waves reflect 1.5 to 3 times more,
// depending on where the layers of the packing lie in the cells. For the same reason they go a part
// of the way to where their neighbours want them: the kink at a row of nodes costs less energy once
// particles have moved, and they do. Scalar shares alone, so that a turned mesh means a turned
// motion.
template <int dim>
std::vector<InterpolatedMotion<dim>> interpolate_motions(const Overlap<dim> &overlap,
                                                         const particles::Particles<dim> &particles,
                                                         const particles::ParticleForce<dim> &force)
{
  constexpr int nc = fem::n_cell_nodes<dim>;
  using Matrix = Eigen::Matrix<double, dim, dim>;
  const int n_members = int(overlap.members.size());
  std::vector<std::vector<int>> neighbours(n_members);
  const std::vector<int> members = overlap.member_particles();
  force.for_each_neighbour(
      particles,
      [&](const particles::Neighbour &n) {
        const int i = overlap.member_of_particle[n.i], j = overlap.member_of_particle[n.j];
        if (n.bonded && j >= 0)
          neighbours[i].push_back(j);
      },
      &members);
  std::vector<InterpolatedMotion<dim>> motions(n_members);
  for (int i = 0; i < n_members; ++i) {
    const auto &m = overlap.members[i];
    const Vector<dim> x = get(particles.reference, m.particle);
    Matrix moment = Matrix::Zero();
    Vector<dim> mean = Vector<dim>::Zero(); // of the vectors to the neighbours
    for (const int j : neighbours[i]) {
      const Vector<dim> r =
          overlap.offset(x, get(particles.reference, overlap.members[j].particle));
      moment += r * r.transpose() / r.squaredNorm();
      mean += r;
    }
    const bool alone = m.pad || std::abs(moment.determinant()) < 1e-3;
    for (int a = 0; a < nc; ++a)
      add_share<dim>(motions[i], {m.nodes[a], m.value[a], (alone ? 1. : 0.) * m.gradient.col(a)});
    if (alone)
      continue;
    const Matrix inverse = moment.inverse();
    const double n = double(neighbours[i].size());
    mean /= n;
    for (const int j : neighbours[i]) {
      const auto &other = overlap.members[j];
      const Vector<dim> r = overlap.offset(x, get(particles.reference, other.particle));
      const Vector<dim> g = inverse * r / r.squaredNorm();    // gradient = sum (u_j - u_i) (x) g
      const double pull = relaxation * (1 / n - g.dot(mean)); // 0 in sum if u is affine
      for (int a = 0; a < nc; ++a) {
        add_share<dim>(motions[i], {other.nodes[a], pull * other.value[a], other.value[a] * g});
        add_share<dim>(motions[i], {m.nodes[a], -pull * m.value[a], -m.value[a] * g});
      }
    }
  }
  return motions;
}

template std::vector<InterpolatedMotion<2>>
interpolate_motions(const Overlap<2> &, const particles::Particles<2> &,
                    const particles::ParticleForce<2> &);
template std::vector<InterpolatedMotion<3>>
interpolate_motions(const Overlap<3> &, const particles::Particles<3> &,
                    const particles::ParticleForce<3> &);
} // namespace ligament::coupling
