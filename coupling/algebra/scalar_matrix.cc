#include "coupling/algebra/scalar_matrix.h"

namespace ligament::coupling
{
template <int dim>
ScalarMatrix<dim>::ScalarMatrix(const Eigen::SparseMatrix<double, Eigen::RowMajor> &matrix)
{
  row_start_.push_back(0);
  for (int i = 0; i < matrix.rows(); ++i) {
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(matrix, i); it; ++it) {
      column_.push_back(int(it.col()));
      value_.push_back(it.value());
    }
    if (int(column_.size()) == row_start_.back())
      continue;
    rows_.push_back(i);
    row_start_.push_back(int(column_.size()));
  }
}

template <int dim>
void ScalarMatrix<dim>::multiply(const Nodal<dim> &u, Nodal<dim> &result) const
{
  result.setZero(u.rows(), dim);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    double sum[dim] = {};
    for (int k = row_start_[i]; k < row_start_[i + 1]; ++k) {
      const double *at_column = u.data() + column_[k] * dim;
      for (int c = 0; c < dim; ++c)
        sum[c] += value_[k] * at_column[c];
    }
    for (int c = 0; c < dim; ++c)
      result(rows_[i], c) = sum[c];
  }
}

template class ScalarMatrix<2>;
template class ScalarMatrix<3>;
} // namespace ligament::coupling
