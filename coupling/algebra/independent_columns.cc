#include "coupling/algebra/independent_columns.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ligament::coupling
{
namespace
{
/// Without columns that are empty, and likewise ordered.
Eigen::SparseMatrix<double> without_empty(const Eigen::SparseMatrix<double> &gram,
                                          std::vector<int> &columns)
{
  std::vector<int> number(gram.cols(), -1);
  for (int col = 0; col < gram.cols(); ++col)
    if (gram.coeff(col, col) > 0) {
      number[col] = int(columns.size());
      columns.push_back(col);
    }
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(gram.nonZeros());
  for (const int col : columns)
    for (Eigen::SparseMatrix<double>::InnerIterator it(gram, col); it; ++it)
      if (number[it.row()] >= 0)
        entries.emplace_back(number[it.row()], number[col], it.value());
  Eigen::SparseMatrix<double> filled(columns.size(), columns.size());
  filled.setFromTriplets(entries.begin(), entries.end());
  return filled;
}

/// Of a matrix without empty columns.
std::vector<char> independent_of(const Eigen::SparseMatrix<double> &gram)
{
  const int n = int(gram.rows());
  int band = 0;
  double largest = 0;
  for (int col = 0; col < n; ++col)
    for (Eigen::SparseMatrix<double>::InnerIterator it(gram, col); it; ++it) {
      band = std::max(band, std::abs(int(it.row()) - col));
      if (it.row() == col)
        largest = std::max(largest, it.value());
    }
  // lower(i, i - j): row i, j <= band columns back.
  Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(band + 1, n); // column i holds row i of L
  std::vector<char> keep(n, 1);
  for (int i = 0; i < n; ++i) {
    Eigen::VectorXd row = Eigen::VectorXd::Zero(band + 1);
    for (Eigen::SparseMatrix<double>::InnerIterator it(gram, i); it && it.row() <= i; ++it)
      row[i - it.row()] = it.value();
    const int first = std::max(0, i - band);
    for (int j = first; j < i; ++j) {
      if (!keep[j]) {
        row[i - j] = 0;
        continue;
      }
      double sum = row[i - j];
      for (int k = std::max(first, j - band); k < j; ++k)
        sum -= row[i - k] * lower(j - k, j);
      row[i - j] = sum / lower(0, j);
    }
    double pivot = row[0];
    for (int j = first; j < i; ++j)
      pivot -= row[i - j] * row[i - j];
    keep[i] = pivot > 1e-10 * largest;
    row[0] = keep[i] ? std::sqrt(pivot) : 0;
    if (!keep[i])
      row.setZero();
    lower.col(i) = row;
  }
  return keep;
}
} // namespace

// Most nodes near an overlap have no entry: the band of the others is narrower.
std::vector<char> independent_columns(const Eigen::SparseMatrix<double> &gram)
{
  std::vector<int> columns;
  const std::vector<char> of_filled = independent_of(without_empty(gram, columns));
  std::vector<char> keep(gram.cols(), 0);
  for (std::size_t k = 0; k < columns.size(); ++k)
    keep[columns[k]] = of_filled[k];
  return keep;
}

template <int dim>
std::vector<int> nodes_along_overlap(const Overlap<dim> &overlap)
{
  std::vector<int> order(overlap.n_nodes());
  std::iota(order.begin(), order.end(), 0);
  Vector<dim> low = overlap.mesh.nodes[overlap.near_nodes[0]], high = low;
  for (const int node : overlap.near_nodes) {
    low = low.cwiseMin(overlap.mesh.nodes[node]);
    high = high.cwiseMax(overlap.mesh.nodes[node]);
  }
  int axis;
  (high - low).maxCoeff(&axis);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return overlap.mesh.nodes[overlap.near_nodes[a]][axis] <
           overlap.mesh.nodes[overlap.near_nodes[b]][axis];
  });
  return order;
}

template std::vector<int> nodes_along_overlap(const Overlap<2> &);
template std::vector<int> nodes_along_overlap(const Overlap<3> &);
} // namespace ligament::coupling
