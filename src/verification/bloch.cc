#include "src/verification/bloch.h"

#include "core/check.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
template <int dim>
BlochWaves<dim>::BlochWaves(const particles::Particles<dim> &particles,
                            const particles::ParticleForce<dim> &force, int centre, int axis)
{
  using Kind = typename particles::QuadraticTerm<dim>::Kind;
  force.add_tangent([&](const particles::QuadraticTerm<dim> &term) {
    // Bonds belong to both ends, the volumetric energy to its particle.
    const bool is_bond = term.kind == Kind::bond;
    const int ends = is_bond ? 2 : 1;
    const auto own = std::count(term.members.begin(), term.members.begin() + ends, centre);
    if (own == 0)
      return;
    Term t{double(own) / ends, {}, term.rows, term.stiffness};
    for (const int i : term.members)
      t.place.push_back(particles.reference[axis][i]);
    terms_.push_back(std::move(t));
  });
  core::require(!terms_.empty(), "no bonds around the centre of the waves");
  inverse_root_mass_.template head<dim>().setConstant(1 / std::sqrt(particles.mass[centre]));
  inverse_root_mass_.template tail<n_spins<dim>>().setConstant(
      1 / std::sqrt(particles.inertia[centre]));
}

template <int dim>
BlochMode<dim> BlochWaves<dim>::mode(double wave_number, const Vector<dim> &polarisation) const
{
  Matrix dynamic = Matrix::Zero();
  for (const Term &t : terms_) {
    Eigen::MatrixXcd rows = Eigen::MatrixXcd::Zero(t.rows.rows(), dofs);
    for (std::size_t m = 0; m < t.place.size(); ++m)
      rows += std::polar(1., wave_number * t.place[m]) *
              t.rows.middleCols(m * dofs, dofs).template cast<std::complex<double>>();
    dynamic += t.share * rows.adjoint() * t.stiffness.asDiagonal() * rows;
  }
  dynamic = (inverse_root_mass_.asDiagonal() * dynamic * inverse_root_mass_.asDiagonal()).eval();
  // A Hermitian matrix A + iB as the symmetric one [A -B; B A]: every eigenvalue comes twice.
  Eigen::MatrixXd symmetric(2 * dofs, 2 * dofs);
  symmetric << dynamic.real(), -dynamic.imag(), dynamic.imag(), dynamic.real();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(symmetric);
  const auto &values = solver.eigenvalues();
  const auto &vectors = solver.eigenvectors();

  // Eigenvalues grow: the first that moves along the polarisation is the acoustic one.
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(2 * dofs);
  direction.head<dim>() = polarisation;
  int first = 0;
  while (first < 2 * dofs - 1 && std::abs(vectors.col(first).dot(direction)) < 0.2)
    ++first;
  Eigen::VectorXd projection = Eigen::VectorXd::Zero(2 * dofs);
  const double tolerance = 1e-6 * values[2 * dofs - 1];
  for (int i = 0; i < 2 * dofs; ++i)
    if (std::abs(values[i] - values[first]) < tolerance)
      projection += vectors.col(i) * vectors.col(i).dot(direction);

  BlochMode<dim> mode;
  mode.frequency = std::sqrt(std::max(0., values[first]));
  mode.amplitude.real() = projection.head(dofs);
  mode.amplitude.imag() = projection.tail(dofs);
  mode.amplitude = inverse_root_mass_.asDiagonal() * mode.amplitude;
  mode.amplitude /= polarisation.dot(mode.amplitude.template head<dim>().real());
  return mode;
}

template <int dim>
double BlochWaves<dim>::group_velocity(double wave_number, const Vector<dim> &polarisation) const
{
  const double step = 1e-4 * wave_number;
  return (mode(wave_number + step, polarisation).frequency -
          mode(wave_number - step, polarisation).frequency) /
         (2 * step);
}

template class BlochWaves<2>;
template class BlochWaves<3>;
} // namespace ligament::program
