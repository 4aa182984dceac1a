// Block assembly against plain sums in a dense matrix.
#include "algebra/block_matrix.h"
#include "core/check.h"

#include <gtest/gtest.h>

#include <random>

namespace
{
using namespace ligament;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

MatrixXd dense(const algebra::BlockMatrix &matrix)
{
  const int b = matrix.block_size();
  MatrixXd result = MatrixXd::Zero(matrix.n_unknowns(), matrix.n_unknowns());
  for (int row = 0; row < matrix.n_rows(); ++row)
    for (auto k = matrix.row_start()[row]; k < matrix.row_start()[row + 1]; ++k)
      result.block(b * row, b * matrix.column()[k], b, b) +=
          Eigen::Map<const RowMajor>(matrix.value() + k * b * b, b, b);
  return result;
}

class Blocks : public ::testing::TestWithParam<int>
{
};

TEST_P(Blocks, RandomTermsAddUpToTheirSum)
{
  constexpr int n_rows = 40;
  const int b = GetParam();
  std::mt19937 random(7);
  std::vector<std::vector<int>> terms(60);
  for (auto &members : terms) {
    members.resize(1 + random() % 9);
    for (int &member : members)
      member = int(random() % (n_rows - 2)); // some members twice, the last rows in no term
  }
  algebra::BlockAssembly assembly(n_rows, b);
  for (const auto &members : terms)
    assembly.announce(members.data(), int(members.size()));
  assembly.close();

  MatrixXd sum = MatrixXd::Zero(b * n_rows, b * n_rows), size = sum;
  for (const auto &members : terms) {
    const int n = int(members.size());
    const RowMajor half = RowMajor::Random(b * n, b * n), entries = half + half.transpose();
    assembly.add(members.data(), n, entries.data());
    for (int r = 0; r < n; ++r)
      for (int c = 0; c < n; ++c) {
        sum.block(b * members[r], b * members[c], b, b) += entries.block(b * r, b * c, b, b);
        size.block(b * members[r], b * members[c], b, b).array() += 2; // bound of one entry
      }
  }
  const RowMajor block = RowMajor::Random(b, b);
  assembly.add_block(terms[0].front(), terms[0].back(), block.data());
  assembly.add_block(n_rows - 1, n_rows - 1, block.data());
  sum.block(b * terms[0].front(), b * terms[0].back(), b, b) += block;
  sum.block(b * (n_rows - 1), b * (n_rows - 1), b, b) += block;

  const algebra::BlockMatrix matrix = assembly.take();
  ASSERT_EQ(matrix.n_rows(), n_rows);
  // The same additions in the same order: to the bit.
  EXPECT_EQ((dense(matrix) - sum).cwiseAbs().maxCoeff(), 0);
  EXPECT_EQ((dense(matrix.copy()) - sum).cwiseAbs().maxCoeff(), 0);
  EXPECT_EQ((matrix.diagonal() - sum.diagonal()).cwiseAbs().maxCoeff(), 0);
  for (int row = 0; row < n_rows; ++row) {
    bool has_diagonal = false;
    for (auto k = matrix.row_start()[row]; k < matrix.row_start()[row + 1]; ++k) {
      has_diagonal |= matrix.column()[k] == row;
      if (k > matrix.row_start()[row]) {
        EXPECT_LT(matrix.column()[k - 1], matrix.column()[k]);
      }
    }
    EXPECT_TRUE(has_diagonal) << row;
  }

  const VectorXd x = VectorXd::Random(sum.rows());
  VectorXd y;
  matrix.multiply(x, y);
  // n additions of products of at most 1 and an entry: n half units of the sum of sizes.
  const double bound = double(sum.rows()) * 1.2e-16 * (sum.cwiseAbs() * x.cwiseAbs()).maxCoeff();
  EXPECT_LE((y - sum * x).cwiseAbs().maxCoeff(), 2 * bound);
  EXPECT_GT(y.norm(), 1);
}

INSTANTIATE_TEST_SUITE_P(OfSize, Blocks, ::testing::Values(1, 2, 3, 6));

TEST(BlockAssembly, RefusesWhatNobodyAnnounced)
{
  algebra::BlockAssembly assembly(4, 1);
  const int members[] = {0, 1}, others[] = {1, 2}, outside[] = {4};
  const int far[] = {0, 3}, between[] = {0, 2};
  assembly.announce(members, 2);
  assembly.announce(far, 2);
  const double entries[] = {1, -1, -1, 1};
  EXPECT_THROW(assembly.add(members, 2, entries), core::InputError); // before close
  assembly.close();
  EXPECT_THROW(assembly.announce(members, 2), core::InputError); // after it
  EXPECT_THROW(assembly.add(others, 2, entries), core::InputError);
  EXPECT_THROW(assembly.add(between, 2, entries), core::InputError);
  EXPECT_THROW(assembly.add_block(1, 2, entries), core::InputError);
  EXPECT_EQ(assembly.take().n_blocks(), 8); // 4 diagonals and two pairs

  assembly.announce(outside, 1);
  EXPECT_THROW(assembly.close(), core::InputError);
  EXPECT_THROW(algebra::BlockAssembly(4, 5), core::InputError);
}

TEST(BlockAssembly, BeginsAnewOnceTheMatrixIsTaken)
{
  algebra::BlockAssembly assembly(3, 1);
  const int first[] = {0, 1}, second[] = {1, 2};
  const double entries[] = {1, -1, -1, 1};
  assembly.announce(first, 2);
  assembly.close();
  assembly.add(first, 2, entries);
  assembly.take();
  assembly.announce(second, 2);
  assembly.close();
  assembly.add(second, 2, entries);
  EXPECT_EQ(assembly.take().diagonal(), VectorXd::LinSpaced(3, 0, 2).cwiseMin(1));
}
} // namespace
