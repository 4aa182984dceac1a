// A symmetric sparse matrix of square blocks, and how it is added up from terms of a few members.
#pragma once

#include "core/large_array.h"

#include <Eigen/Core>

#include <cstdint>
#include <utility>
#include <vector>

namespace ligament::algebra
{
/// Symmetric sparse matrix of square blocks in compressed rows; both halves are stored.
class BlockMatrix
{
public:
  BlockMatrix() = default;

  /// Some rows of such a matrix. Their columns are numbered otherwise, those of the rows themselves
  /// first; other columns have no rows here, and x in A x is longer than y.
  BlockMatrix(int block_size, std::vector<std::int64_t> row_start, std::vector<int> column,
              core::LargeArray value)
      : block_size_(block_size), row_start_(std::move(row_start)), column_(std::move(column)),
        value_(std::move(value))
  {
  }

  int block_size() const { return block_size_; }
  int n_rows() const { return int(row_start_.size()) - 1; } // of blocks
  std::int64_t n_unknowns() const { return std::int64_t(n_rows()) * block_size_; }
  std::int64_t n_blocks() const { return row_start_.back(); }

  /// y = A x.
  void multiply(const Eigen::VectorXd &x, Eigen::VectorXd &y) const;
  /// The same on plain arrays of n_unknowns(), which must not overlap.
  void multiply(const double *x, double *y) const;

  /// Where the blocks of a row begin; one more entry than rows.
  const std::vector<std::int64_t> &row_start() const { return row_start_; }
  /// Of each block; ascending in a row.
  const std::vector<int> &column() const { return column_; }
  /// block_size^2 of each block, row-major.
  const double *value() const { return value_.data(); }

  /// A_ii of every unknown.
  Eigen::VectorXd diagonal() const;

  /// change(double &entry) on A_ii of every unknown in turn.
  template <typename Change>
  void for_each_diagonal(Change &&change)
  {
    for (int row = 0; row < n_rows(); ++row)
      for (std::int64_t k = row_start_[row]; k < row_start_[row + 1]; ++k)
        for (int c = 0; c < block_size_ && column_[k] == row; ++c)
          change(value_.data()[(k * block_size_ + c) * block_size_ + c]);
  }

  BlockMatrix copy() const;

private:
  friend class BlockAssembly;

  int block_size_ = 1;
  std::vector<std::int64_t> row_start_ = {0};
  std::vector<int> column_;
  core::LargeArray value_;
};

/// Adds up terms, each on a few block rows: first their members are announced, then, after close(),
/// their entries are added.
class BlockAssembly
{
public:
  BlockAssembly(int n_rows, int block_size);

  /// First pass: these rows will be added to together. The same member twice is allowed.
  void announce(const int *members, int n);

  /// Makes the pattern, where every row has its diagonal, with zeros in it.
  void close();

  /// entries: (n * block_size)^2, row-major, symmetric.
  void add(const int *members, int n, const double *entries);

  /// Adds to one block; its transpose is the caller's.
  void add_block(int row, int column, const double *entries);

  /// Hands the matrix over; what comes after begins anew, with announcements.
  BlockMatrix take();

private:
  template <int size>
  void add_of_size(const int *members, int n, const double *entries);
  double *block(int row, int column);

  int n_rows_;
  bool closed_ = false;
  std::vector<int> member_;                    // of all terms, one after the other
  std::vector<std::int64_t> term_start_ = {0}; // into member_
  std::vector<std::pair<int, int>> order_;     // members of the present term, ascending, and places
  BlockMatrix matrix_;
};
} // namespace ligament::algebra
