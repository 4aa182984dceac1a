// Conjugate gradients end where they should, and say how.
#include "algebra/conjugate_gradients.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <random>

namespace
{
using namespace ligament;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using End = algebra::CgResult::End;

constexpr int n = 60;

/// Symmetric with these eigenvalues and random eigenvectors.
MatrixXd with_eigenvalues(const VectorXd &values)
{
  std::srand(3);
  const MatrixXd q = Eigen::HouseholderQR<MatrixXd>(MatrixXd::Random(n, n)).householderQ();
  return q * values.asDiagonal() * q.transpose();
}

template <typename Project>
algebra::CgResult solve(const MatrixXd &a, const VectorXd &right, VectorXd &x, double tolerance,
                        int most, Project &&project)
{
  return algebra::conjugate_gradients([&](const VectorXd &p, VectorXd &ap) { ap = a * p; },
                                      [](const VectorXd &r, VectorXd &z) { z = r; }, project,
                                      project, right, x, tolerance, most);
}

algebra::CgResult solve(const MatrixXd &a, const VectorXd &right, VectorXd &x, double tolerance,
                        int most = 1000)
{
  return solve(a, right, x, tolerance, most, [](VectorXd &) {});
}

TEST(ConjugateGradients, TakeAsManyIterationsAsThereAreEigenvalues)
{
  VectorXd values(n);
  for (int k = 0; k < n; ++k)
    values[k] = 1 + k % 3;
  const MatrixXd a = with_eigenvalues(values);
  const VectorXd right = VectorXd::Random(n);
  VectorXd x;
  const auto result = solve(a, right, x, 1e-10);
  EXPECT_EQ(result.end, End::converged);
  EXPECT_EQ(result.iterations, 3);
  EXPECT_LE((right - a * x).norm(), 1e-10);
}

TEST(ConjugateGradients, GoOnFromWhatTheyAreGiven)
{
  const MatrixXd a = with_eigenvalues(VectorXd::LinSpaced(n, 1, 100));
  const VectorXd right = VectorXd::Random(n);
  VectorXd x = a.ldlt().solve(right);
  const auto result = solve(a, right, x, 1e-10);
  EXPECT_EQ(result.end, End::converged);
  EXPECT_EQ(result.iterations, 0);
  EXPECT_LE(result.residual, 1e-10);
}

TEST(ConjugateGradients, StopAtRoundOff)
{
  const MatrixXd a = with_eigenvalues(
      VectorXd::LinSpaced(n, 0, 8).array().unaryExpr([](double e) { return std::pow(10, e); }));
  const VectorXd right = VectorXd::Random(n);
  VectorXd x;
  const auto result = solve(a, right, x, 0, 100000);
  EXPECT_EQ(result.end, End::stalled);
  EXPECT_LT(result.iterations, 100000);
  // What is said of the residual is the true one; norm(A) norm(x) eps bounds what can be had.
  EXPECT_DOUBLE_EQ(result.residual, (right - a * x).norm());
  EXPECT_LE(result.residual, 100 * 2.3e-16 * 1e8 * x.norm());
}

// Directions of an exact inverse are smooth, and show nothing of how stiff the operator is: a soft
// body moves far, and what its forces cancel to is noise.
TEST(ConjugateGradients, SayTheTrueResidualOfASoftBody)
{
  const VectorXd values =
      VectorXd::LinSpaced(n, -10, 0).array().unaryExpr([](double e) { return std::pow(10, e); });
  const MatrixXd a = with_eigenvalues(values), inverse = with_eigenvalues(values.cwiseInverse());
  const VectorXd right = VectorXd::Random(n);
  VectorXd x;
  const auto result =
      algebra::conjugate_gradients([&](const VectorXd &p, VectorXd &ap) { ap = a * p; },
                                   [&](const VectorXd &r, VectorXd &z) { z = inverse * r; }, right,
                                   x, 1e-13 * right.norm(), 1000);
  EXPECT_EQ(result.end, End::stalled);
  EXPECT_LT(result.iterations, 100);
  EXPECT_DOUBLE_EQ(result.residual, (right - a * x).norm());
}

TEST(ConjugateGradients, StopAtTheLastIteration)
{
  const MatrixXd a = with_eigenvalues(VectorXd::LinSpaced(n, 1, 1000));
  const VectorXd right = VectorXd::Random(n);
  VectorXd x;
  const auto result = solve(a, right, x, 1e-12, 5);
  EXPECT_EQ(result.end, End::stalled);
  EXPECT_EQ(result.iterations, 5);
  EXPECT_DOUBLE_EQ(result.residual, (right - a * x).norm());
}

TEST(ConjugateGradients, NoticeNegativeCurvature)
{
  VectorXd values = VectorXd::LinSpaced(n, 1, 10);
  values[17] = -0.01;
  const MatrixXd a = with_eigenvalues(values);
  VectorXd x;
  EXPECT_EQ(solve(a, VectorXd::Random(n), x, 1e-10).end, End::indefinite);
}

TEST(ConjugateGradients, NoticeALoadThatNothingResists)
{
  VectorXd values = VectorXd::LinSpaced(n, 1, 10);
  values[17] = 0;
  const MatrixXd a = with_eigenvalues(values);
  VectorXd x;
  EXPECT_EQ(solve(a, VectorXd::Random(n), x, 1e-10).end, End::indefinite);
}

TEST(ConjugateGradients, NoticeWhatRoundOffResists)
{
  VectorXd values = VectorXd::Ones(n);
  values[17] = 1e-17;
  const MatrixXd a = values.asDiagonal();
  VectorXd x;
  EXPECT_EQ(solve(a, VectorXd::Ones(n), x, 1e-10).end, End::indefinite);
}

TEST(ConjugateGradients, StopWhereTheOperatorIsNotExacter)
{
  const MatrixXd a = with_eigenvalues(VectorXd::LinSpaced(n, 1, 100));
  const VectorXd right = VectorXd::Random(n);
  VectorXd x;
  const auto single = [&](const VectorXd &p, VectorXd &ap) {
    ap = (a * p).cast<float>().cast<double>();
  };
  const auto result = algebra::conjugate_gradients(
      single, [](const VectorXd &r, VectorXd &z) { z = r; }, right, x, 1e-13, 100000);
  EXPECT_EQ(result.end, End::stalled);
  EXPECT_LT(result.iterations, 100000);
  VectorXd image;
  single(x, image);
  EXPECT_DOUBLE_EQ(result.residual, (right - image).norm());
}

TEST(ConjugateGradients, ProjectFreeMotionsOut)
{
  // Without an inverse near zero: a chain of springs, free to move as a whole.
  MatrixXd a = MatrixXd::Zero(n, n);
  for (int k = 0; k + 1 < n; ++k)
    a.block(k, k, 2, 2) += (Eigen::Matrix2d() << 1, -1, -1, 1).finished();
  const auto without_mean = [](VectorXd &v) { v.array() -= v.mean(); };
  const VectorXd right = VectorXd::Random(n); // its mean is what nothing resists
  VectorXd x;
  const auto result = solve(a, right, x, 1e-10, 1000, without_mean);
  EXPECT_EQ(result.end, End::converged);
  VectorXd rest = right - a * x;
  without_mean(rest);
  EXPECT_LE(rest.norm(), 1e-10);
  EXPECT_LE(std::abs(x.mean()), 1e-14 * x.norm());
}

TEST(ConjugateGradients, NothingToDo)
{
  const MatrixXd a = with_eigenvalues(VectorXd::LinSpaced(n, 1, 10));
  VectorXd x;
  const auto result = solve(a, VectorXd::Zero(n), x, 0);
  EXPECT_EQ(result.end, End::converged);
  EXPECT_EQ(result.iterations, 0);
  EXPECT_EQ(x.norm(), 0);
}
} // namespace
