#include "algebra/preconditioner.h"

#include "algebra/cholesky.h"
#include "algebra/multigrid.h"
#include "algebra/parallel_multigrid.h"

namespace ligament::algebra
{
std::unique_ptr<Preconditioner> make_preconditioner(Preconditioning kind, const BlockMatrix &matrix,
                                                    const Eigen::MatrixXd &modes, int dimension,
                                                    const core::Ranks &helpers)
{
  const bool factorise = kind == Preconditioning::cholesky ||
                         (kind == Preconditioning::automatic &&
                          matrix.n_unknowns() <= most_unknowns_to_factorise(dimension));
  if (factorise)
    return make_cholesky(matrix, Ordering::nested_dissection);
  return kind == Preconditioning::parallel_multigrid
             ? make_parallel_multigrid(matrix, modes, helpers)
             : make_multigrid(matrix, modes);
}
} // namespace ligament::algebra
