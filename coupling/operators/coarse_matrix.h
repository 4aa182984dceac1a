// The patch fit's second level while it is summed up: a symmetric matrix of dense blocks, one per
// pair of hats, however many blocks of cells add to it.
#pragma once

#include <Eigen/SparseCore>

#include <map>
#include <vector>

namespace ligament::coupling
{
/// Blocks of `size` unknowns.
template <int size>
class CoarseMatrix
{
public:
  using Block = Eigen::Matrix<double, size, size, Eigen::DontAlign>;

  explicit CoarseMatrix(int n) : columns_(n) {}

  /// row >= column
  Block &at(int row, int column)
  {
    return columns_[column].try_emplace(row, Block::Zero()).first->second;
  }

  /// All that Eigen's Cholesky factors read. Gives the memory of the blocks back on the way.
  Eigen::SparseMatrix<double> lower_half()
  {
    const int n = size * int(columns_.size());
    Eigen::SparseMatrix<double> matrix(n, n);
    long entries = 0;
    for (const auto &column : columns_)
      entries += long(column.size()) * size * size;
    matrix.reserve(entries);
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      for (int c = 0; c < size; ++c) {
        matrix.startVec(int(j) * size + c);
        for (const auto &[i, block] : columns_[j])
          for (int r = std::size_t(i) == j ? c : 0; r < size; ++r)
            matrix.insertBack(i * size + r, int(j) * size + c) = block(r, c);
      }
      columns_[j].clear();
    }
    matrix.finalize();
    return matrix;
  }

private:
  std::vector<std::map<int, Block>> columns_;
};
} // namespace ligament::coupling
