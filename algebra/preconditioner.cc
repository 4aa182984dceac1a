#include "algebra/preconditioner.h"

#include "algebra/cholesky.h"
#include "algebra/multigrid.h"

namespace ligament::algebra
{
std::unique_ptr<Preconditioner> make_preconditioner(Preconditioning kind, const BlockMatrix &matrix,
                                                    const Eigen::MatrixXd &modes, int dimension)
{
  const bool factorise = kind == Preconditioning::cholesky ||
                         (kind == Preconditioning::automatic &&
                          matrix.n_unknowns() <= most_unknowns_to_factorise(dimension));
  return factorise ? make_cholesky(matrix, Ordering::nested_dissection)
                   : make_multigrid(matrix, modes);
}
} // namespace ligament::algebra
