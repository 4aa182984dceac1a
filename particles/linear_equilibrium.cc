#include "particles/linear_equilibrium.h"

#include "core/check.h"

#include <Eigen/SparseCholesky>

namespace ligament::particles
{
template <int dim>
void solve_equilibrium(const Particles<dim> &particles, const ParticleForce<dim> &force,
                       const std::vector<char> &is_free, Eigen::VectorXd &motion,
                       const Eigen::VectorXd &load)
{
  constexpr int dofs = n_particle_dofs<dim>;
  std::vector<int> unknown(is_free.size(), -1), free;
  for (std::size_t i = 0; i < is_free.size(); ++i)
    if (is_free[i]) {
      unknown[i] = int(free.size());
      free.push_back(int(i));
    }
  const int n_unknown = int(free.size());

  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(dofs * n_unknown);
  for (int row = 0; row < n_unknown && load.size() > 0; ++row)
    right.segment<dofs>(dofs * row) = load.segment<dofs>(dofs * free[row]);
  const auto add_term = [&](const QuadraticTerm<dim> &term) {
    core::require(term.rows.cols() == long(dofs * term.members.size()),
                  "static equilibrium: the force has no rotations");
    const Eigen::MatrixXd k = term.rows.transpose() * term.stiffness.asDiagonal() * term.rows;
    for (std::size_t a = 0; a < term.members.size(); ++a) {
      const int row = unknown[term.members[a]];
      if (row < 0)
        continue;
      for (std::size_t b = 0; b < term.members.size(); ++b) {
        const int column = unknown[term.members[b]];
        const auto block = k.block<dofs, dofs>(dofs * a, dofs * b);
        if (column < 0)
          right.segment<dofs>(dofs * row) -= block * motion.segment<dofs>(dofs * term.members[b]);
        else if (column <= row) // the solver reads the lower half
          for (int r = 0; r < dofs; ++r)
            for (int c = 0; c < dofs; ++c)
              entries.emplace_back(dofs * row + r, dofs * column + c, block(r, c));
      }
    }
  };
  force.add_tangent(particles, add_term, &free);
  Eigen::SparseMatrix<double> matrix(right.size(), right.size());
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> solver(matrix);
  core::require<core::EnvironmentError>(
      solver.info() == Eigen::Success,
      "static equilibrium: the stiffness cannot be factorised; a part of the body is not held");
  const Eigen::VectorXd solution = solver.solve(right);
  for (std::size_t i = 0; i < is_free.size(); ++i)
    if (is_free[i])
      motion.segment<dofs>(dofs * i) = solution.segment<dofs>(dofs * unknown[i]);
}

template void solve_equilibrium(const Particles<2> &, const ParticleForce<2> &,
                                const std::vector<char> &, Eigen::VectorXd &,
                                const Eigen::VectorXd &);
template void solve_equilibrium(const Particles<3> &, const ParticleForce<3> &,
                                const std::vector<char> &, Eigen::VectorXd &,
                                const Eigen::VectorXd &);
} // namespace ligament::particles
