#include "coupling/algebra/block_matrix.h"

namespace ligament::coupling
{
template <int dim>
BlockMatrix<dim>::BlockMatrix(const Eigen::SparseMatrix<double> &matrix)
{
  const int n = int(matrix.rows()) / dim;
  row_start_.push_back(0);
  std::vector<int> place(n, -1); // of a column in the present row
  for (int node = 0; node < n; ++node) {
    for (int c = 0; c < dim; ++c) // symmetric: a column is a row
      for (Eigen::SparseMatrix<double>::InnerIterator it(matrix, c * n + node); it; ++it) {
        const int other = int(it.row()) % n, component = int(it.row()) / n;
        if (place[other] < row_start_.back()) {
          place[other] = int(column_.size());
          column_.push_back(other);
          block_.emplace_back();
          block_.back().setZero();
        }
        block_[place[other]](c, component) = it.value();
      }
    row_start_.push_back(int(column_.size()));
  }
}

template <int dim>
double BlockMatrix<dim>::subtract_product(const Nodal<dim> &u, Nodal<dim> &result) const
{
  const int n = int(row_start_.size()) - 1;
  const double *x = u.data();
  double form = 0;
  for (int node = 0; node < n; ++node) {
    double sum[dim] = {};
    for (int k = row_start_[node]; k < row_start_[node + 1]; ++k) {
      const double *xk = x + column_[k] * dim;
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
          sum[i] += block_[k](i, j) * xk[j];
    }
    for (int i = 0; i < dim; ++i) {
      result(node, i) -= sum[i];
      form += x[node * dim + i] * sum[i];
    }
  }
  return form;
}

template class BlockMatrix<2>;
template class BlockMatrix<3>;
} // namespace ligament::coupling
