// The largest frequency of the linearised body by Lanczos iteration through the force routine.
#include "dem/many_body_force.h"

#include <Eigen/Eigenvalues>

namespace ligament::dem
{
namespace
{
/// Scatters M^(-1/2) x into displacements and rotations, small against everything.
template <int dim>
void set_motion(particles::Particles<dim> &p, const Eigen::VectorXd &x, double amplitude)
{
  const int n = p.size();
  for (int i = 0; i < n; ++i) {
    const double a = amplitude * std::sqrt(p.inverse_mass(i)),
                 b = amplitude * std::sqrt(p.inverse_inertia(i));
    for (int c = 0; c < dim; ++c)
      p.displacement[c][i] = a * x[c * n + i];
    for (int c = 0; c < n_spins<dim>; ++c)
      p.rotation[dim == 2 ? 0 : c + 1][i] = (dim == 2 ? b : b / 2) * x[(dim + c) * n + i];
    if (dim == 3) // to first order; the amplitude makes the rest vanish
      p.rotation[0][i] = 1;
  }
}

/// -M^(-1/2) f / amplitude = M^(-1/2) K M^(-1/2) x.
template <int dim>
void get_force(const particles::Particles<dim> &p, Eigen::VectorXd &y, double amplitude)
{
  const int n = p.size();
  for (int i = 0; i < n; ++i) {
    const double a = -std::sqrt(p.inverse_mass(i)) / amplitude,
                 b = -std::sqrt(p.inverse_inertia(i)) / amplitude;
    for (int c = 0; c < dim; ++c)
      y[c * n + i] = a * p.force[c][i];
    for (int c = 0; c < n_spins<dim>; ++c)
      y[(dim + c) * n + i] = b * p.torque[c][i];
  }
}
} // namespace

template <int dim>
double ManyBodyForce<dim>::stable_step(const Particles &particles) const
{
  core::require(!strains_.has_begun(), "the stable step is that of a body without strains of its own");
  Particles p = particles;
  Evaluation<dim> evaluation(body_);
  evaluation.has_loads = false;
  const int size = n_particle_dofs<dim> * p.size();
  // Scaled so that the largest displacement stays far below the spacing, whatever the units.
  double largest = 0;
  for (int i = 0; i < p.size(); ++i)
    largest = std::max(largest, p.inverse_mass(i));
  core::require(largest > 0, "no particle is free to move");
  const double amplitude = 1e-9 * body_.spacing() / std::sqrt(largest);

  Eigen::VectorXd v(size), previous = Eigen::VectorXd::Zero(size), y(size);
  std::uint64_t state = 88172645463325252ull; // xorshift: the same start vector everywhere
  for (int i = 0; i < size; ++i) {
    state ^= state << 13, state ^= state >> 7, state ^= state << 17;
    v[i] = double(state >> 11) / double(1ull << 53) - 0.5;
  }
  v.normalize();
  const int steps = std::min(80, size);
  std::vector<double> diagonal, off_diagonal;
  double beta = 0;
  for (int s = 0; s < steps; ++s) {
    set_motion(p, v, amplitude);
    find_forces(p, evaluation);
    get_force(p, y, amplitude);
    diagonal.push_back(v.dot(y));
    y -= diagonal.back() * v + beta * previous;
    beta = y.norm();
    if (!(beta > 1e-12 * std::abs(diagonal.front())))
      break;
    off_diagonal.push_back(beta);
    previous = v;
    v = y / beta;
  }
  jumps_.show(true);
  const int m = int(diagonal.size());
  off_diagonal.resize(m);
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(Eigen::Map<Eigen::VectorXd>(diagonal.data(), m),
                                Eigen::Map<Eigen::VectorXd>(off_diagonal.data(), m - 1),
                                Eigen::EigenvaluesOnly);
  const double omega = std::sqrt(solver.eigenvalues().maxCoeff());
  const double step = 2 / (1.01 * omega), damping = strains_.longest_damping() / step;
  // Of dashpots on the rate of half a step before, theory.md section 1.10.
  return damping > 0 ? step / (std::sqrt(1 + damping * damping) + damping) : step;
}

template double ManyBodyForce<2>::stable_step(const Particles &) const;
template double ManyBodyForce<3>::stable_step(const Particles &) const;
} // namespace ligament::dem
