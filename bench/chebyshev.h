// A polynomial in the mass matrix in place of its inverse: the rival of a factorisation.
#pragma once

#include "coupling/algebra/scalar_matrix.h"

#include <cmath>

namespace ligament::bench
{
/// Chebyshev iteration of fixed degree for M x = b, scaled by the diagonal of M: a polynomial that
/// is symmetric and positive, so that a leap-frog with it is exact for a slightly different mass.
template <int dim>
class Chebyshev
{
public:
  /// The degree follows from the spectrum: error below the tolerance for every right-hand side.
  Chebyshev(const Eigen::SparseMatrix<double> &mass, double tolerance) : mass_(mass)
  {
    inverse_diagonal_ = mass.diagonal().cwiseInverse();
    const double largest = eigenvalue(mass, 0), smallest = largest + eigenvalue(mass, largest);
    centre_ = (largest + smallest) / 2;
    half_width_ = (largest - smallest) / 2;
    const double root = std::sqrt(largest / smallest);
    degree_ = int(std::ceil(std::log(2 / tolerance) / std::log((root + 1) / (root - 1))));
  }

  int degree() const { return degree_; }

  void solve(coupling::Nodal<dim> &x) const
  {
    right_ = x;
    step_ = inverse_diagonal_.asDiagonal() * right_ / centre_;
    x = step_;
    const double sigma = centre_ / half_width_;
    double rho = 1 / sigma;
    for (int k = 1; k < degree_; ++k) {
      mass_.multiply(x, product_);
      const double next = 1 / (2 * sigma - rho);
      const double *b = right_.data(), *p = product_.data();
      for (Eigen::Index i = 0; i < x.rows(); ++i)
        for (int c = 0; c < dim; ++c) {
          double &step = step_(i, c);
          const double residual = inverse_diagonal_[i] * (b[i * dim + c] - p[i * dim + c]);
          step = next * rho * step + 2 * next / half_width_ * residual;
          x(i, c) += step;
        }
      rho = next;
    }
  }

private:
  /// Of D^-1 M - shift, the one of largest magnitude; a little too large.
  double eigenvalue(const Eigen::SparseMatrix<double> &mass, double shift) const
  {
    Eigen::VectorXd x = Eigen::VectorXd::Random(mass.rows());
    double value = 0;
    for (int k = 0; k < 300; ++k) {
      x /= x.norm();
      const Eigen::VectorXd next = (mass * x).cwiseProduct(inverse_diagonal_) - shift * x;
      value = x.dot(next);
      x = next;
    }
    return 1.001 * value;
  }

  coupling::ScalarMatrix<dim> mass_;
  Eigen::VectorXd inverse_diagonal_;
  double centre_, half_width_;
  int degree_;
  mutable coupling::Nodal<dim> right_, step_, product_;
};
} // namespace ligament::bench
