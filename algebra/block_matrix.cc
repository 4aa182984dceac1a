#include "algebra/block_matrix.h"

#include "core/check.h"

#include <algorithm>

namespace ligament::algebra
{
namespace
{
template <int size>
void multiply_rows(const BlockMatrix &matrix, const double *x, double *y)
{
  const std::int64_t *start = matrix.row_start().data();
  const int *column = matrix.column().data();
  const double *value = matrix.value();
  for (int row = 0; row < matrix.n_rows(); ++row) {
    double sum[size] = {};
    for (std::int64_t k = start[row]; k < start[row + 1]; ++k) {
      const double *block = value + k * (size * size), *part = x + std::int64_t(column[k]) * size;
      for (int r = 0; r < size; ++r)
        for (int c = 0; c < size; ++c)
          sum[r] += block[r * size + c] * part[c];
    }
    for (int r = 0; r < size; ++r)
      y[std::int64_t(row) * size + r] = sum[r];
  }
}
} // namespace

void BlockMatrix::multiply(const double *x, double *y) const
{
  switch (block_size_) {
  case 1:
    return multiply_rows<1>(*this, x, y);
  case 2:
    return multiply_rows<2>(*this, x, y);
  case 3:
    return multiply_rows<3>(*this, x, y);
  case 6:
    return multiply_rows<6>(*this, x, y);
  default:
    core::require(false, "a block matrix has blocks of 1, 2, 3 or 6 unknowns");
  }
}

void BlockMatrix::multiply(const Eigen::VectorXd &x, Eigen::VectorXd &y) const
{
  core::require(x.size() == n_unknowns(), "a block matrix and a vector differ in size");
  y.resize(x.size());
  multiply(x.data(), y.data());
}

Eigen::VectorXd BlockMatrix::diagonal() const
{
  Eigen::VectorXd result(n_unknowns());
  const int b = block_size_;
  for (int row = 0; row < n_rows(); ++row)
    for (std::int64_t k = row_start_[row]; k < row_start_[row + 1]; ++k)
      for (int c = 0; c < b && column_[k] == row; ++c)
        result[std::int64_t(row) * b + c] = value()[(k * b + c) * b + c];
  return result;
}

BlockMatrix BlockMatrix::copy() const
{
  BlockMatrix result;
  result.block_size_ = block_size_;
  result.row_start_ = row_start_;
  result.column_ = column_;
  const std::size_t n_entries = std::size_t(n_blocks()) * block_size_ * block_size_;
  result.value_ = core::LargeArray(n_entries, true);
  std::copy_n(value(), n_entries, result.value_.data());
  return result;
}
} // namespace ligament::algebra
