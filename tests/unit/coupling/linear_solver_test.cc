// Solvers of the overlap's systems against the product with their matrix.
#include "coupling/algebra/linear_solver.h"
#include "coupling/algebra/tiled_cholesky.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace ligament::coupling
{
namespace
{
using Matrix = Eigen::SparseMatrix<double>;

/// A strip of nx by ny nodes, closed to a ring on request, the unknowns shuffled: 1 on the
/// diagonal, less than 0.1 between each of up to eight neighbours.
Matrix strip(int nx, int ny, bool ring, std::mt19937 &random)
{
  std::vector<int> number(nx * ny);
  std::iota(number.begin(), number.end(), 0);
  std::shuffle(number.begin(), number.end(), random);
  std::uniform_real_distribution<double> share(0.02, 0.1);
  std::vector<Eigen::Triplet<double>> entries;
  const auto at = [&](int x, int y) { return number[(x + nx) % nx + nx * y]; };
  for (int y = 0; y < ny; ++y)
    for (int x = 0; x < nx; ++x) {
      entries.emplace_back(at(x, y), at(x, y), 1);
      for (const auto &[dx, dy] :
           {std::pair(1, 0), std::pair(0, 1), std::pair(1, 1), std::pair(-1, 1)}) {
        if (y + dy >= ny || (!ring && (x + dx < 0 || x + dx >= nx)))
          continue;
        const double value = share(random);
        entries.emplace_back(at(x, y), at(x + dx, y + dy), value);
        entries.emplace_back(at(x + dx, y + dy), at(x, y), value);
      }
    }
  Matrix matrix(nx * ny, nx * ny);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Largest |A solve(x) - x| for random right-hand sides of order 1.
double residual(const LinearSolver &solver, const Matrix &matrix, int n_columns)
{
  const Rows right = Rows::Random(matrix.rows(), n_columns);
  Rows x = right;
  solver.solve(x.data(), n_columns);
  return (matrix * x - right).cwiseAbs().maxCoeff();
}

// Diagonally dominant by at least 0.2: |A^-1| <= 5, |x| <= 5, row sums of |A| <= 1.8.
constexpr double round_off = 2.2e-16;
constexpr double bound = 9 * 10 * round_off; // ten operations deep

class LinearSolverTest : public ::testing::TestWithParam<Solver>
{
};

TEST_P(LinearSolverTest, SolvesPositiveDefiniteSystems)
{
  std::mt19937 random(1);
  for (const bool ring : {false, true})
    for (const auto &[nx, ny] :
         {std::pair(3, 1), std::pair(4, 2), std::pair(31, 7), std::pair(40, 10)}) {
      const Matrix matrix = strip(nx, ny, ring, random);
      const auto solver = make_linear_solver(GetParam());
      solver->factorise(matrix);
      for (int n_columns = 1; n_columns <= 3; ++n_columns)
        EXPECT_LT(residual(*solver, matrix, n_columns), bound)
            << nx << " by " << ny << (ring ? " ring" : "");
    }
}

// [A, B; B^T, -C] with A and C from above: as dominant, as B has one entry of 0.1 in a row.
TEST_P(LinearSolverTest, SolvesConstrainedSystems)
{
  std::mt19937 random(2);
  const Matrix a = strip(21, 5, false, random), c = strip(7, 3, false, random);
  const int n = int(a.rows()), m = int(c.rows());
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](const Matrix &block, int first, double factor) {
    for (int j = 0; j < block.cols(); ++j)
      for (Matrix::InnerIterator it(block, j); it; ++it)
        entries.emplace_back(first + it.row(), first + j, factor * it.value());
  };
  add(a, 0, 1);
  add(c, n, -1);
  for (int i = 0; i < m; ++i) {
    entries.emplace_back(n + i, 5 * i, 0.1);
    entries.emplace_back(5 * i, n + i, 0.1);
  }
  Matrix matrix(n + m, n + m);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const auto solver = make_linear_solver(GetParam());
  solver->factorise_constrained(matrix);
  EXPECT_LT(residual(*solver, matrix, 2), 2 * bound);
}

INSTANTIATE_TEST_SUITE_P(Libraries, LinearSolverTest,
                         ::testing::Values(Solver::eigen, Solver::amesos));

TEST(NarrowOrder, KeepsTheNeighboursOfAStripTogether)
{
  std::mt19937 random(3);
  for (const bool ring : {false, true}) {
    const Matrix matrix = strip(40, 5, ring, random);
    const std::vector<int> order = narrow_order(matrix);
    std::vector<int> place(order.size(), -1);
    for (std::size_t i = 0; i < order.size(); ++i)
      place[order[i]] = int(i);
    EXPECT_EQ(std::count(place.begin(), place.end(), -1), 0);
    int width = 0;
    for (int j = 0; j < matrix.cols(); ++j)
      for (Matrix::InnerIterator it(matrix, j); it; ++it)
        width = std::max(width, std::abs(place[j] - place[it.row()]));
    // Two levels of the search, of one slice each (in a ring two), and the slanted levels near a
    // corner: twice as many.
    EXPECT_LE(width, (ring ? 2 : 1) * 4 * 5);
  }
}
} // namespace
} // namespace ligament::coupling
