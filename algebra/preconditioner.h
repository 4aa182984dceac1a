// What makes conjugate gradients on a body's stiffness short: a factor of a matrix near it, or
// multigrid.
#pragma once

#include "algebra/block_matrix.h"
#include "core/ranks.h"

#include <memory>

namespace ligament::algebra
{
enum class Preconditioning
{
  automatic,         // Cholesky up to most_unknowns_to_factorise, multigrid above
  cholesky,          // supernodal, of CHOLMOD
  multigrid,         // smoothed aggregation, of Trilinos ML
  parallel_multigrid // the same, its levels shared out among ranks
};

/// Where set-up and some ten solves take equally long (bench/algebra.cc, reference BLAS).
constexpr std::int64_t most_unknowns_to_factorise(int dimension)
{
  return dimension == 2 ? 20000 : 5000;
}

/// z near A^-1 r, symmetric and positive definite. One thread at a time.
class Preconditioner
{
public:
  virtual ~Preconditioner() = default;

  virtual void apply(const Eigen::VectorXd &r, Eigen::VectorXd &z) const = 0;

  virtual const char *name() const = 0;
};

/// matrix: not negative; it is copied or factorised, and need not outlive the call. Its diagonal is
/// raised by 1e-9 of itself, so that motions that nothing resists don't matter; unknowns without
/// entries (held components, rotations that nodes lack) keep what they are given. modes: near null
/// space (rigid motions), one column each, n_rows * block_size long; multigrid needs them.
/// dimension: 2 or 3, of space. Throws core::EnvironmentError where the matrix isn't positive
/// definite (Cholesky) or the library fails. helpers: of parallel_multigrid, whose first rank this
/// is (algebra/parallel_multigrid.h); by one process it is multigrid.
std::unique_ptr<Preconditioner> make_preconditioner(Preconditioning kind, const BlockMatrix &matrix,
                                                    const Eigen::MatrixXd &modes, int dimension,
                                                    const core::Ranks &helpers = {});
} // namespace ligament::algebra
