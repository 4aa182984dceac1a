// A sparse matrix of dim x dim blocks on nodes: the coarse stiffness as the time loop multiplies
// it.
#pragma once

#include "coupling/operators/transfer.h"

#include <Eigen/SparseCore>

namespace ligament::coupling
{
template <int dim>
class BlockMatrix
{
public:
  /// From a symmetric matrix whose unknowns are numbered component by component,
  /// c * n_nodes + node.
  explicit BlockMatrix(const Eigen::SparseMatrix<double> &matrix);

  /// result -= A u; returns u.A u.
  double subtract_product(const Nodal<dim> &u, Nodal<dim> &result) const;

private:
  std::vector<int> row_start_, column_;
  std::vector<Eigen::Matrix<double, dim, dim, Eigen::RowMajor | Eigen::DontAlign>> block_;
};
} // namespace ligament::coupling
