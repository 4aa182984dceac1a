#include "algebra/cholesky.h"

#include "algebra/raised_diagonal.h"
#include "core/check.h"

#include <cholmod.h>
#include <omp.h>

#include <limits>
#include <string>

namespace ligament::algebra
{
namespace
{
/// CHOLMOD's settings and workspace; it remembers here how the last call ended.
class Workspace
{
public:
  Workspace()
  {
    cholmod_start(&common);
    common.print = 0; // what went wrong is thrown
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_GIVEN;
  }
  ~Workspace() { cholmod_finish(&common); }
  Workspace(const Workspace &) = delete;
  Workspace &operator=(const Workspace &) = delete;

  mutable cholmod_common common;
};

/// CHOLMOD asks for four threads whatever the machine has to spare; theirs would be idle waits.
class OneThread
{
public:
  OneThread() : levels_(omp_get_max_active_levels()) { omp_set_max_active_levels(0); }
  ~OneThread() { omp_set_max_active_levels(levels_); }
  OneThread(const OneThread &) = delete;
  OneThread &operator=(const OneThread &) = delete;

private:
  int levels_;
};

void check(const cholmod_common &common)
{
  using core::EnvironmentError;
  core::require<EnvironmentError>(common.status != CHOLMOD_NOT_POSDEF,
                                  "Cholesky: the matrix isn't positive definite");
  core::require<EnvironmentError>(common.status != CHOLMOD_OUT_OF_MEMORY,
                                  "Cholesky: not enough memory; take multigrid");
  core::require<EnvironmentError>(common.status != CHOLMOD_TOO_LARGE,
                                  "Cholesky: too many unknowns; take multigrid");
  core::require<EnvironmentError>(common.status >= CHOLMOD_OK,
                                  "Cholesky: CHOLMOD failed with status " +
                                      std::to_string(common.status));
}

/// Lower half by columns, `size` unknowns per block; only the pattern of blocks where size is 0.
cholmod_sparse *lower_half(const BlockMatrix &matrix, int size, cholmod_common &common)
{
  const int b = std::max(1, size), bb = matrix.block_size() * matrix.block_size();
  std::size_t n_entries = 0;
  for (int row = 0; row < matrix.n_rows(); ++row)
    for (auto k = matrix.row_start()[row]; k < matrix.row_start()[row + 1]; ++k)
      n_entries += matrix.column()[k] > row    ? b * b
                   : matrix.column()[k] == row ? b * (b + 1) / 2
                                               : 0;
  core::require<core::EnvironmentError>(n_entries < std::size_t(std::numeric_limits<int>::max()),
                                        "Cholesky: too many unknowns; take multigrid");
  const std::size_t n = std::size_t(matrix.n_rows()) * b;
  cholmod_sparse *const half = cholmod_allocate_sparse(
      n, n, n_entries, true, true, -1, size > 0 ? CHOLMOD_REAL : CHOLMOD_PATTERN, &common);
  check(common);
  int *const start = static_cast<int *>(half->p), *const index = static_cast<int *>(half->i);
  double *const value = static_cast<double *>(half->x);
  int n_done = 0;
  // Symmetric: the entries of a row from the diagonal on are those of a column.
  for (int row = 0; row < matrix.n_rows(); ++row)
    for (int r = 0; r < b; ++r) {
      start[row * b + r] = n_done;
      for (auto k = matrix.row_start()[row]; k < matrix.row_start()[row + 1]; ++k) {
        const int column = matrix.column()[k];
        for (int c = column > row ? 0 : column == row ? r : b; c < b; ++c) {
          index[n_done] = column * b + c;
          if (size > 0) {
            const double entry = matrix.value()[k * bb + r * b + c];
            value[n_done] = column == row && c == r ? raised(entry) : entry;
          }
          ++n_done;
        }
      }
    }
  start[n] = n_done;
  return half;
}

/// An order of the unknowns that keeps the factor thin, found on whole blocks.
std::vector<int> order_unknowns(const BlockMatrix &matrix, Ordering ordering,
                                cholmod_common &common)
{
  cholmod_sparse *blocks = lower_half(matrix, 0, common);
  std::vector<int> of_blocks(matrix.n_rows());
  if (ordering == Ordering::minimum_degree)
    cholmod_amd(blocks, nullptr, 0, of_blocks.data(), &common);
  else
    cholmod_metis(blocks, nullptr, 0, true, of_blocks.data(), &common);
  cholmod_free_sparse(&blocks, &common);
  check(common);
  std::vector<int> result;
  result.reserve(matrix.n_unknowns());
  for (const int row : of_blocks)
    for (int c = 0; c < matrix.block_size(); ++c)
      result.push_back(row * matrix.block_size() + c);
  return result;
}

class Cholesky : public Preconditioner
{
public:
  Cholesky(const BlockMatrix &matrix, Ordering ordering)
  {
    const OneThread here;
    cholmod_common &common = workspace_.common;
    std::vector<int> order = order_unknowns(matrix, ordering, common);
    cholmod_sparse *half = lower_half(matrix, matrix.block_size(), common);
    factor_ = cholmod_analyze_p(half, order.data(), nullptr, 0, &common);
    if (factor_)
      cholmod_factorize(half, factor_, &common);
    cholmod_free_sparse(&half, &common);
    if (common.status != CHOLMOD_OK)
      cholmod_free_factor(&factor_, &common); // no destructor will
    check(common);
  }

  ~Cholesky() override
  {
    cholmod_free_dense(&solution_, &workspace_.common);
    cholmod_free_dense(&scratch_, &workspace_.common);
    cholmod_free_dense(&more_scratch_, &workspace_.common);
    cholmod_free_factor(&factor_, &workspace_.common);
  }

  void apply(const Eigen::VectorXd &r, Eigen::VectorXd &z) const override
  {
    const OneThread here;
    cholmod_dense right = {};
    right.nrow = right.nzmax = right.d = factor_->n;
    right.ncol = 1;
    right.x = const_cast<double *>(r.data());
    right.xtype = CHOLMOD_REAL;
    right.dtype = CHOLMOD_DOUBLE;
    cholmod_solve2(CHOLMOD_A, factor_, &right, nullptr, &solution_, nullptr, &scratch_,
                   &more_scratch_, &workspace_.common);
    check(workspace_.common);
    z = Eigen::Map<const Eigen::VectorXd>(static_cast<const double *>(solution_->x), r.size());
  }

  const char *name() const override { return "Cholesky"; }

private:
  Workspace workspace_;
  cholmod_factor *factor_ = nullptr;
  // Kept from one call to the next.
  mutable cholmod_dense *solution_ = nullptr, *scratch_ = nullptr, *more_scratch_ = nullptr;
};
} // namespace

std::unique_ptr<Preconditioner> make_cholesky(const BlockMatrix &matrix, Ordering ordering)
{
  return std::make_unique<Cholesky>(matrix, ordering);
}
} // namespace ligament::algebra
