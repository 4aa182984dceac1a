// Pattern and entries of a block matrix from terms of a few members.
#include "algebra/block_matrix.h"
#include "core/check.h"

#include <algorithm>
#include <limits>

namespace ligament::algebra
{
namespace
{
// Apart from the loop that asks: the text of a check is made whether it holds or not.
[[noreturn]] void refuse(const char *reason = "a term was added that nobody announced")
{
  throw core::InputError(reason);
}
} // namespace

BlockAssembly::BlockAssembly(int n_rows, int block_size) : n_rows_(n_rows)
{
  core::require(block_size == 1 || block_size == 2 || block_size == 3 || block_size == 6,
                "a block matrix has blocks of 1, 2, 3 or 6 unknowns");
  matrix_.block_size_ = block_size;
}

void BlockAssembly::announce(const int *members, int n)
{
  if (closed_)
    refuse("a term was announced to a pattern that is made already");
  member_.insert(member_.end(), members, members + n);
  term_start_.push_back(std::int64_t(member_.size()));
}

void BlockAssembly::close()
{
  const std::size_t n_terms = term_start_.size() - 1;
  core::require<core::EnvironmentError>(n_terms < std::numeric_limits<std::uint32_t>::max(),
                                        "a block matrix has too many terms");
  // The terms of each row, by counting.
  std::vector<std::int64_t> start(n_rows_ + 1, 0);
  for (const int row : member_) {
    if (row < 0 || row >= n_rows_)
      refuse("a term has a member that is no row of the matrix");
    ++start[row + 1];
  }
  for (int row = 0; row < n_rows_; ++row)
    start[row + 1] += start[row];
  std::vector<std::uint32_t> term(member_.size());
  for (std::size_t t = 0; t < n_terms; ++t)
    for (std::int64_t k = term_start_[t]; k < term_start_[t + 1]; ++k)
      term[start[member_[k]]++] = std::uint32_t(t);
  // `start` has moved on by one row.

  matrix_.row_start_.assign(1, 0);
  matrix_.row_start_.reserve(n_rows_ + 1);
  matrix_.column_.clear();
  std::vector<int> seen_by(n_rows_, -1), columns;
  for (int row = 0; row < n_rows_; ++row) {
    columns.assign(1, row);
    seen_by[row] = row;
    for (std::int64_t k = row > 0 ? start[row - 1] : 0; k < start[row]; ++k)
      for (std::int64_t m = term_start_[term[k]]; m < term_start_[term[k] + 1]; ++m)
        if (seen_by[member_[m]] != row) {
          seen_by[member_[m]] = row;
          columns.push_back(member_[m]);
        }
    std::sort(columns.begin(), columns.end());
    matrix_.column_.insert(matrix_.column_.end(), columns.begin(), columns.end());
    matrix_.row_start_.push_back(std::int64_t(matrix_.column_.size()));
  }
  member_ = {};
  term_start_ = {0};
  const std::size_t entries = std::size_t(matrix_.block_size_) * matrix_.block_size_;
  matrix_.value_ = core::LargeArray(matrix_.column_.size() * entries, true);
  closed_ = true;
}

template <int size>
void BlockAssembly::add_of_size(const int *members, int n, const double *entries)
{
  // Members in ascending order, so that one walk through a row meets them all.
  order_.resize(n);
  for (int a = 0; a < n; ++a) {
    int place = a;
    for (; place > 0 && order_[place - 1].first > members[a]; --place)
      order_[place] = order_[place - 1];
    order_[place] = {members[a], a};
  }
  const int *column = matrix_.column_.data();
  double *value = matrix_.value_.data();
  const int stride = n * size;
  for (int a = 0; a < n; ++a) {
    std::int64_t k = matrix_.row_start_[members[a]];
    const std::int64_t end = matrix_.row_start_[members[a] + 1];
    const double *from_row = entries + a * size * stride;
    for (const auto &[other, b] : order_) {
      while (k < end && column[k] < other)
        ++k;
      if (k == end || column[k] != other)
        refuse();
      double *to = value + k * (size * size);
      const double *from = from_row + b * size;
      for (int r = 0; r < size; ++r)
        for (int c = 0; c < size; ++c)
          to[r * size + c] += from[r * stride + c];
    }
  }
}

void BlockAssembly::add(const int *members, int n, const double *entries)
{
  if (!closed_)
    refuse("a term was added to a pattern that isn't made yet");
  switch (matrix_.block_size_) {
  case 1:
    return add_of_size<1>(members, n, entries);
  case 2:
    return add_of_size<2>(members, n, entries);
  case 3:
    return add_of_size<3>(members, n, entries);
  default:
    return add_of_size<6>(members, n, entries);
  }
}

double *BlockAssembly::block(int row, int column)
{
  const auto begin = matrix_.column_.begin() + matrix_.row_start_[row];
  const auto end = matrix_.column_.begin() + matrix_.row_start_[row + 1];
  const auto found = std::lower_bound(begin, end, column);
  if (found == end || *found != column)
    refuse();
  const std::size_t entries = std::size_t(matrix_.block_size_) * matrix_.block_size_;
  return matrix_.value_.data() + std::size_t(found - matrix_.column_.begin()) * entries;
}

void BlockAssembly::add_block(int row, int column, const double *entries)
{
  if (!closed_)
    refuse("a block was added to a pattern that isn't made yet");
  double *to = block(row, column);
  for (int k = 0; k < matrix_.block_size_ * matrix_.block_size_; ++k)
    to[k] += entries[k];
}

BlockMatrix BlockAssembly::take()
{
  core::require(closed_, "a matrix was taken before its pattern was made");
  closed_ = false;
  BlockMatrix result = std::move(matrix_);
  matrix_ = BlockMatrix();
  matrix_.block_size_ = result.block_size_;
  return result;
}
} // namespace ligament::algebra
