#include "coupling/algebra/tiled_cholesky.h"

#include "core/check.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <map>
#include <set>

namespace ligament::coupling
{
namespace
{
using Matrix = Eigen::SparseMatrix<double>;

/// Unknowns of one connected part by their distance from `start`, those with fewer neighbours
/// first.
std::vector<int> by_distance(const Matrix &matrix, int start, std::vector<int> &mark, int colour)
{
  const auto n_neighbours = [&](int i) {
    return matrix.outerIndexPtr()[i + 1] - matrix.outerIndexPtr()[i];
  };
  std::vector<int> found = {start}, next;
  mark[start] = colour;
  for (std::size_t k = 0; k < found.size(); ++k) {
    next.clear();
    for (Matrix::InnerIterator it(matrix, found[k]); it; ++it)
      if (mark[it.row()] != colour) {
        mark[it.row()] = colour;
        next.push_back(int(it.row()));
      }
    std::stable_sort(next.begin(), next.end(),
                     [&](int a, int b) { return n_neighbours(a) < n_neighbours(b); });
    found.insert(found.end(), next.begin(), next.end());
  }
  return found;
}

std::vector<int> minimum_degree(const Matrix &matrix)
{
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> inverse;
  Eigen::AMDOrdering<int>()(matrix, inverse);
  return {inverse.indices().data(), inverse.indices().data() + inverse.size()};
}

Matrix in_order(const Matrix &matrix, const std::vector<int> &order)
{
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation(matrix.rows());
  for (std::size_t i = 0; i < order.size(); ++i)
    permutation.indices()[order[i]] = int(i);
  return Matrix(permutation * matrix * permutation.transpose());
}

/// Off-diagonal tiles of L, without its numbers: every row of L lies in the union of what its
/// columns' parents pass on.
std::size_t count_tiles(const Matrix &matrix, const std::vector<int> &order)
{
  const Matrix ordered = in_order(matrix, order);
  const int n_blocks = (int(ordered.rows()) + lane_array_size - 1) / lane_array_size;
  std::vector<std::set<int>> below(n_blocks);
  for (int j = 0; j < ordered.cols(); ++j)
    for (Matrix::InnerIterator it(ordered, j); it; ++it)
      if (it.row() / lane_array_size > j / lane_array_size)
        below[j / lane_array_size].insert(int(it.row()) / lane_array_size);
  std::size_t n_tiles = 0;
  for (const auto &rows : below) {
    n_tiles += rows.size();
    if (!rows.empty())
      below[*rows.begin()].insert(std::next(rows.begin()), rows.end());
  }
  return n_tiles;
}

std::vector<int> best_order(const Matrix &matrix)
{
  std::vector<int> narrow = narrow_order(matrix), sparse = minimum_degree(matrix);
  return count_tiles(matrix, narrow) <= count_tiles(matrix, sparse) ? narrow : sparse;
}
} // namespace

std::vector<int> narrow_order(const Matrix &matrix)
{
  const int n = int(matrix.rows());
  std::vector<int> order, mark(n, 0);
  int colour = 0;
  for (int i = 0; i < n; ++i) {
    if (mark[i] > 0)
      continue;
    // Twice to the far end, then all the way back.
    int end = i;
    for (int round = 0; round < 2; ++round)
      end = by_distance(matrix, end, mark, ++colour).back();
    const auto part = by_distance(matrix, end, mark, ++colour);
    order.insert(order.end(), part.begin(), part.end());
  }
  std::reverse(order.begin(), order.end());
  return order;
}

void TiledCholesky::factorise(const Matrix &matrix)
{
  const std::vector<int> order = best_order(matrix);
  const Eigen::SimplicialLLT<Matrix, Eigen::Lower, Eigen::NaturalOrdering<int>> cholesky(
      in_order(matrix, order));
  core::require(cholesky.info() == Eigen::Success,
                "an overlap system is not positive definite: the overlap holds too few particles "
                "for its cells; raise /far_field/cell_size or /coupling/overlap_cells");
  negative_.clear();
  take(cholesky.matrixL(), order);
}

// Such a matrix has P A P^T = L D L^T without pivoting, with D of both signs: kept as
// (L |D|^1/2) sign(D) (L |D|^1/2)^T.
void TiledCholesky::factorise_constrained(const Matrix &matrix)
{
  const std::vector<int> order = best_order(matrix);
  const Eigen::SimplicialLDLT<Matrix, Eigen::Lower, Eigen::NaturalOrdering<int>> cholesky(
      in_order(matrix, order));
  const Eigen::VectorXd d = cholesky.vectorD();
  core::require(cholesky.info() == Eigen::Success && d.cwiseAbs().minCoeff() > 0,
                "the multipliers of the overlap depend on each other; raise "
                "/far_field/cell_size or /coupling/overlap_cells");
  negative_.clear();
  for (int j = 0; j < d.size(); ++j)
    if (d[j] < 0)
      negative_.push_back(j);
  const Matrix unit = cholesky.matrixL();
  take(unit * d.cwiseAbs().cwiseSqrt().asDiagonal(), order);
}

void TiledCholesky::take(const Matrix &lower, const std::vector<int> &order)
{
  using Dense =
      Eigen::Matrix<double, lane_array_size, lane_array_size>; // column by column, as Tile
  const int n = int(order.size()), n_blocks = (n + lane_array_size - 1) / lane_array_size;
  place_.resize(n);
  for (int i = 0; i < n; ++i)
    place_[order[i]] = i;

  std::map<std::pair<int, int>, Dense> tiles; // (row, column) of the lower triangle
  for (int k = 0; k < n_blocks; ++k)
    tiles.emplace(std::pair(k, k), Dense::Zero());
  for (int i = n; i < n_blocks * lane_array_size; ++i) // unknowns that fill up the last block
    tiles.at({n_blocks - 1, n_blocks - 1})(i % lane_array_size, i % lane_array_size) = 1;
  for (int j = 0; j < n; ++j)
    for (Matrix::InnerIterator it(lower, j); it; ++it) {
      const std::pair place(int(it.row()) / lane_array_size, j / lane_array_size);
      tiles.try_emplace(place, Dense::Zero())
          .first->second(it.row() % lane_array_size, j % lane_array_size) = it.value();
    }

  const auto to_tile = [](const Dense &dense) {
    Tile tile;
    Eigen::Map<Dense>(&tile.value[0][0]) = dense;
    return tile;
  };
  const auto add_step = [&](TileSweep &sweep, int block, bool transposed,
                            const std::vector<std::pair<int, const Dense *>> &others) {
    const int begin = int(sweep.tiles.size());
    for (const auto &[other, dense] : others) {
      sweep.other.push_back(other);
      sweep.tiles.push_back(to_tile(transposed ? dense->transpose() : *dense));
    }
    const Dense inverse =
        tiles.at({block, block}).triangularView<Eigen::Lower>().solve(Dense::Identity());
    sweep.diagonal.push_back(to_tile(transposed ? inverse.transpose() : inverse));
    sweep.steps.push_back({block, begin, int(sweep.tiles.size())});
  };
  // Nearest block last: it is the one that was solved just before.
  std::vector<std::vector<std::pair<int, const Dense *>>> left(n_blocks), below(n_blocks);
  for (const auto &[place, dense] : tiles)
    if (place.first != place.second) {
      left[place.first].emplace_back(place.second, &dense);
      below[place.second].emplace_back(place.first, &dense);
    }
  forward_ = backward_ = {};
  for (int k = 0; k < n_blocks; ++k)
    add_step(forward_, k, false, left[k]);
  for (int k = n_blocks - 1; k >= 0; --k) {
    std::reverse(below[k].begin(), below[k].end());
    add_step(backward_, k, true, below[k]);
  }
  work_.assign(3 * n_blocks, LaneArray()); // what fills up the last block touches nothing else
}

void TiledCholesky::solve(double *x, int n_columns) const
{
  if (n_columns == 1)
    solve_columns<1>(x);
  else if (n_columns == 2)
    solve_columns<2>(x);
  else
    solve_columns<3>(x);
}

template <int columns>
void TiledCholesky::solve_columns(double *x) const
{
  double *const work = work_.front().value;
  const auto start = [](unsigned place) { // of an unknown's numbers, lane_array_size apart
    return place / lane_array_size * lane_array_size * columns + place % lane_array_size;
  };
  const std::size_t n = place_.size();
  for (std::size_t i = 0; i < n; ++i)
    for (int c = 0; c < columns; ++c)
      work[start(place_[i]) + lane_array_size * c] = x[i * columns + c];
  sweep_tiles(forward_, columns, work_.data());
  for (const int i : negative_)
    for (int c = 0; c < columns; ++c)
      work[start(i) + lane_array_size * c] *= -1;
  sweep_tiles(backward_, columns, work_.data());
  for (std::size_t i = 0; i < n; ++i)
    for (int c = 0; c < columns; ++c)
      x[i * columns + c] = work[start(place_[i]) + lane_array_size * c];
}
} // namespace ligament::coupling
