// A sparse matrix with one number per pair of near nodes, as the time loop multiplies it with all
// components of a nodal field at once.
#pragma once

#include "coupling/operators/transfer.h"

#include <Eigen/SparseCore>

namespace ligament::coupling
{
template <int dim>
class ScalarMatrix
{
public:
  ScalarMatrix() = default;
  explicit ScalarMatrix(const Eigen::SparseMatrix<double, Eigen::RowMajor> &matrix);

  bool is_empty() const { return rows_.empty(); }

  /// result = A u
  void multiply(const Nodal<dim> &u, Nodal<dim> &result) const;

private:
  std::vector<int> rows_, row_start_, column_; // rows that are not empty
  std::vector<double> value_;
};
} // namespace ligament::coupling
