// A sparse matrix of dim x dim blocks that grows while it is assembled: one block per pair of
// nodes, however many terms add to it.
#pragma once

#include "core/types.h"

#include <Eigen/SparseCore>

#include <unordered_map>
#include <vector>

namespace ligament::coupling
{
template <int dim>
class NodalMatrix
{
public:
  explicit NodalMatrix(int n_nodes) : rows_(n_nodes) {}

  /// Adds factor * dense, whose rows and columns are the nodes' components, node by node.
  template <typename Dense>
  void add(const std::vector<int> &nodes, const Dense &dense, double factor = 1)
  {
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      auto &row = rows_[nodes[a]];
      for (std::size_t b = 0; b < nodes.size(); ++b) {
        auto &block = row.try_emplace(nodes[b], Block::Zero()).first->second;
        block += factor * dense.template block<dim, dim>(a * dim, b * dim);
      }
    }
  }

  /// The block of one pair of nodes.
  template <typename Dense>
  void add_block(int row, int column, const Dense &block)
  {
    rows_[row].try_emplace(column, Block::Zero()).first->second += block;
  }

  /// Unknowns numbered component by component: c * n_nodes + node.
  Eigen::SparseMatrix<double> to_sparse() const
  {
    const int n = int(rows_.size());
    std::vector<Eigen::Triplet<double>> triplets;
    for (int a = 0; a < n; ++a)
      for (const auto &[b, block] : rows_[a])
        for (int i = 0; i < dim; ++i)
          for (int j = 0; j < dim; ++j)
            triplets.emplace_back(i * n + a, j * n + b, block(i, j));
    Eigen::SparseMatrix<double> sparse(dim * n, dim * n);
    sparse.setFromTriplets(triplets.begin(), triplets.end());
    return sparse;
  }

private:
  using Block = Eigen::Matrix<double, dim, dim, Eigen::DontAlign>;
  std::vector<std::unordered_map<int, Block>> rows_;
};
} // namespace ligament::coupling
