// Two verbs for the small symmetric positive definite systems of the overlap, and who can do them.
#pragma once

#include "coupling/scheme.h"

#include <Eigen/SparseCore>

#include <memory>

namespace ligament::coupling
{
/// Factorises once, solves for several right-hand sides each step.
class LinearSolver
{
public:
  virtual ~LinearSolver() = default;

  /// Takes a symmetric positive definite matrix; throws core::InputError when it is not.
  virtual void factorise(const Eigen::SparseMatrix<double> &matrix) = 0;

  /// Takes a symmetric matrix of a constrained motion, [A, B; B^T, -C] with A and C positive
  /// definite; throws core::InputError when it is singular.
  virtual void factorise_constrained(const Eigen::SparseMatrix<double> &matrix) = 0;

  /// x <- A^-1 x for n_columns (1 to 3) right-hand sides; x holds n_columns numbers per unknown.
  virtual void solve(double *x, int n_columns) const = 0;
};

std::unique_ptr<LinearSolver> make_linear_solver(Solver solver);
} // namespace ligament::coupling
