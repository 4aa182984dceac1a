// The largest frequency of the linearised body by Lanczos iteration through the force routine.
#include "dem/many_body_force.h"

#include "particles/block_sum.h"

#include <Eigen/Eigenvalues>

#include <numeric>

namespace ligament::dem
{
namespace
{
/// Scatters M^(-1/2) x into displacements and rotations, small against everything.
template <int dim>
void set_motion(particles::Particles<dim> &p, const Eigen::VectorXd &x, double amplitude)
{
  const Eigen::Index n = p.size(); // times its degrees of freedom it may be no int
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

/// -M^(-1/2) f / amplitude = M^(-1/2) K M^(-1/2) x of what is stepped.
template <int dim>
void get_force(const particles::Particles<dim> &p, Eigen::VectorXd &y, double amplitude)
{
  const Eigen::Index n = p.size();
  particles::for_each(p.part.owned, [&](int i) {
    const double a = -std::sqrt(p.inverse_mass(i)) / amplitude,
                 b = -std::sqrt(p.inverse_inertia(i)) / amplitude;
    for (int c = 0; c < dim; ++c)
      y[c * n + i] = a * p.force[c][i];
    for (int c = 0; c < n_spins<dim>; ++c)
      y[(dim + c) * n + i] = b * p.torque[c][i];
  });
}

/// Of the body: over blocks of what is one's own, in strands, which compilers may not make of a
/// sum.
template <int dim>
double dot(const Eigen::VectorXd &a, const Eigen::VectorXd &b, const particles::Particles<dim> &p,
           const core::Ranks &ranks)
{
  const core::ExactSum sum = particles::sum_over_blocks(p.part.owned, [&](const auto &add) {
    for (int c = 0; c < n_particle_dofs<dim>; ++c) {
      const double *const x = a.data() + std::size_t(c) * p.size(), *const y =
                                                                        b.data() +
                                                                        std::size_t(c) * p.size();
      add([=](int begin, int end) {
        constexpr int n_strands = 8;
        double strands[n_strands] = {};
        int i = begin;
        for (; i + n_strands <= end; i += n_strands)
          for (int k = 0; k < n_strands; ++k)
            strands[k] += x[i + k] * y[i + k];
        for (; i < end; ++i)
          strands[0] += x[i] * y[i];
        return std::accumulate(strands, strands + n_strands, 0.);
      });
    }
  });
  return ranks.sum(sum).value();
}

/// One's own entries of a vector of random numbers from -1/2 to 1/2 that the body has, whatever its
/// parts: by the places of the particles in its order.
template <int dim>
Eigen::VectorXd random_vector(const particles::Particles<dim> &p, const core::Ranks &ranks)
{
  std::vector<int> own;
  particles::for_each(p.part.owned, [&](int i) { own.push_back(i); });
  std::int64_t n = 0, begin = 0;
  const auto counts = ranks.gather_all(std::vector<std::int64_t>{std::int64_t(own.size())});
  for (std::size_t r = 0; r < counts.size(); ++r) {
    begin += int(r) < ranks.rank() ? counts[r] : 0;
    n += counts[r];
  }
  Eigen::VectorXd v = Eigen::VectorXd::Zero(n_particle_dofs<dim> * Eigen::Index(p.size()));
  std::uint64_t state = 88172645463325252ull; // xorshift
  for (int c = 0; c < n_particle_dofs<dim>; ++c)
    for (std::int64_t place = 0; place < n; ++place) {
      state ^= state << 13, state ^= state >> 7, state ^= state << 17;
      if (place >= begin && place - begin < std::int64_t(own.size()))
        v[c * Eigen::Index(p.size()) + own[place - begin]] =
            double(state >> 11) / double(1ull << 53) - 0.5;
    }
  return v;
}
} // namespace

template <int dim>
double ManyBodyForce<dim>::stable_step(const Particles &particles) const
{
  core::require(!strains_.has_begun(),
                "the stable step is that of a body without strains of its own");
  Particles p = particles;
  Evaluation<dim> evaluation(body_);
  evaluation.has_loads = false;
  particles::Halo<dim> halo(*owners_, p);
  const auto product = [&](const Eigen::VectorXd &a, const Eigen::VectorXd &b) {
    return dot<dim>(a, b, p, ranks());
  };
  // Scaled so that the largest displacement stays far below the spacing, whatever the units.
  double largest = 0;
  for (int i = 0; i < p.size(); ++i)
    largest = std::max(largest, p.inverse_mass(i));
  for (const double of : ranks().gather_all(std::vector<double>{largest}))
    largest = std::max(largest, of);
  core::require(largest > 0, "no particle is free to move");
  const double amplitude = 1e-9 * body_.spacing() / std::sqrt(largest);

  Eigen::VectorXd v = random_vector(p, ranks()), previous = Eigen::VectorXd::Zero(v.size()),
                  y = previous;
  v /= std::sqrt(product(v, v));
  const std::int64_t size =
      ranks().sum(std::int64_t(n_particle_dofs<dim>) * particles::count(p.part.owned));
  const int steps = int(std::min(std::int64_t(80), size));
  std::vector<double> diagonal, off_diagonal;
  double beta = 0;
  for (int s = 0; s < steps; ++s) {
    set_motion(p, v, amplitude);
    halo.update(p);
    find_forces(p, evaluation);
    get_force(p, y, amplitude);
    diagonal.push_back(product(v, y));
    y -= diagonal.back() * v + beta * previous;
    beta = std::sqrt(product(y, y));
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
