// Both preconditioners lead to the solution that a dense factorisation finds, on small bodies.
#include "algebra/conjugate_gradients.h"
#include "algebra/preconditioner.h"
#include "core/check.h"
#include "tests/support/lattice_body.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <string>

namespace
{
using namespace ligament;
using algebra::Preconditioning;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using End = algebra::CgResult::End;

MatrixXd dense(const algebra::BlockMatrix &matrix)
{
  const auto n = matrix.n_unknowns();
  MatrixXd result(n, n);
  VectorXd column;
  for (int k = 0; k < n; ++k) {
    matrix.multiply(VectorXd::Unit(n, k), column);
    result.col(k) = column;
  }
  return result;
}

template <typename Project>
algebra::CgResult solve(const algebra::BlockMatrix &matrix, const algebra::Preconditioner &near,
                        const VectorXd &right, VectorXd &x, Project &&project)
{
  return algebra::conjugate_gradients(
      [&](const VectorXd &p, VectorXd &ap) { matrix.multiply(p, ap); },
      [&](const VectorXd &r, VectorXd &z) { near.apply(r, z); }, project, project, right, x,
      1e-10 * right.norm(), 200);
}

void nothing(VectorXd &)
{
}

struct Case
{
  const char *name;
  Preconditioning kind;
  int dim;
  bool has_spins;
};

class Bodies : public ::testing::TestWithParam<Case>
{
protected:
  Bodies() : body(GetParam().dim, GetParam().has_spins, sides()) {}

  static std::vector<int> sides()
  {
    return GetParam().dim == 2 ? std::vector<int>{14, 14} : std::vector<int>{4, 4, 4};
  }
  auto preconditioner(const algebra::BlockMatrix &matrix) const
  {
    return algebra::make_preconditioner(GetParam().kind, matrix, body.modes(), GetParam().dim);
  }

  const test::LatticeBody body;
};

TEST_P(Bodies, HeldOnOneSide)
{
  const auto matrix = body.matrix([](const Eigen::Vector3d &x) { return x[1] < 0.1; });
  const auto near = preconditioner(matrix);
  const VectorXd right = VectorXd::Random(matrix.n_unknowns());
  VectorXd x;
  const auto result = solve(matrix, *near, right, x, nothing);
  EXPECT_EQ(result.end, End::converged);
  EXPECT_LE(result.iterations, GetParam().kind == Preconditioning::cholesky ? 3 : 60);
  const MatrixXd a = dense(matrix);
  const VectorXd exact = a.ldlt().solve(right);
  // |x - exact| is at most |A^-1| |r|.
  const double weakest = Eigen::SelfAdjointEigenSolver<MatrixXd>(a, false).eigenvalues()[0];
  EXPECT_GT(weakest, 1e-6);
  EXPECT_LE((x - exact).norm(), 1.01e-10 * right.norm() / weakest);
}

TEST_P(Bodies, FreeMotionsProjectedOut)
{
  const auto matrix = body.matrix([](const Eigen::Vector3d &) { return false; });
  const MatrixXd rigid = Eigen::HouseholderQR<MatrixXd>(body.modes()).householderQ() *
                         MatrixXd::Identity(matrix.n_unknowns(), body.modes().cols());
  // They are free: the rows of terms cancel to round-off.
  EXPECT_LE((dense(matrix) * rigid).norm(), 1e-12);
  const auto project = [&](VectorXd &v) { v -= rigid * (rigid.transpose() * v).eval(); };
  const auto near = preconditioner(matrix);
  const VectorXd right = VectorXd::Random(matrix.n_unknowns());
  VectorXd x;
  const auto result = solve(matrix, *near, right, x, project);
  EXPECT_EQ(result.end, End::converged);
  EXPECT_LE(result.iterations, GetParam().kind == Preconditioning::cholesky ? 4 : 60);
  VectorXd image;
  matrix.multiply(x, image);
  VectorXd rest = right - image;
  project(rest);
  EXPECT_LE(rest.norm(), 1.01e-10 * right.norm());
  EXPECT_LE((rigid.transpose() * x).norm(), 1e-10 * x.norm());
}

TEST_P(Bodies, FreeMotionsAreRaised)
{
  // With d the diagonal, r.(A + 1e-9 d)^-1 r of a free motion r lies between these two; multigrid
  // has the motion on its coarsest level, and never answers more than the inverse.
  const auto matrix = body.matrix([](const Eigen::Vector3d &) { return false; });
  const auto near = preconditioner(matrix);
  const VectorXd r = body.modes().col(0), d = matrix.diagonal();
  VectorXd z;
  near->apply(r, z);
  EXPECT_GE(r.dot(z),
            0.99 * r.squaredNorm() * r.squaredNorm() / (1e-9 * r.dot(d.asDiagonal() * r)));
  EXPECT_LE(r.dot(z), 1.01 * r.squaredNorm() / (1e-9 * d.minCoeff()));
}

TEST_P(Bodies, InertRowsKeepWhatTheyAreGiven)
{
  // One row more than particles, in no term, and a particle whose first component is held.
  const int b = body.block_size(), held = 5, n = body.n() + 1;
  algebra::BlockAssembly assembly(n, b);
  for (const auto &term : body.terms())
    assembly.announce(term.members.data(), int(term.members.size()));
  assembly.close();
  for (const auto &term : body.terms()) {
    MatrixXd entries = *term.entries;
    for (std::size_t k = 0; k < term.members.size(); ++k)
      if (term.members[k] == held) {
        entries.row(k * b).setZero();
        entries.col(k * b).setZero();
      }
    assembly.add(term.members.data(), int(term.members.size()), entries.data());
  }
  const MatrixXd ground = MatrixXd::Identity(b, b);
  for (int i = 0; i < body.n(); i += 7)
    if (i != held)
      assembly.add_block(i, i, ground.data());
  const auto matrix = assembly.take();
  MatrixXd modes = MatrixXd::Zero(n * b, body.modes().cols());
  modes.topRows(body.n() * b) = body.modes();
  modes.row(held * b).setZero();

  const auto near = algebra::make_preconditioner(GetParam().kind, matrix, modes, GetParam().dim);
  VectorXd right = VectorXd::Random(n * b);
  right.tail(b).setZero();
  right[held * b] = 0;
  VectorXd x;
  const auto result = solve(matrix, *near, right, x, nothing);
  EXPECT_EQ(result.end, End::converged);
  EXPECT_EQ(x[held * b], 0);
  EXPECT_EQ(x.tail(b).norm(), 0);
  VectorXd z;
  near->apply(VectorXd::Unit(n * b, held * b), z);
  EXPECT_NEAR(z[held * b], 1, 1e-6);
}

TEST_P(Bodies, SymmetricAndPositive)
{
  const auto matrix = body.matrix([](const Eigen::Vector3d &x) { return x[1] < 0.1; });
  const auto near = preconditioner(matrix);
  VectorXd image_a, image_b;
  for (int k = 0; k < 5; ++k) {
    const VectorXd a = VectorXd::Random(matrix.n_unknowns()), b = VectorXd::Random(a.size());
    near->apply(a, image_a);
    near->apply(b, image_b);
    EXPECT_NEAR(a.dot(image_b), b.dot(image_a), 1e-9 * a.norm() * image_b.norm());
    EXPECT_GT(a.dot(image_a), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, Bodies,
    ::testing::Values(Case{"FlatCholesky", Preconditioning::cholesky, 2, true},
                      Case{"FlatCholeskyWithoutSpins", Preconditioning::cholesky, 2, false},
                      Case{"FlatMultigrid", Preconditioning::multigrid, 2, true},
                      Case{"FlatMultigridWithoutSpins", Preconditioning::multigrid, 2, false},
                      Case{"SolidCholesky", Preconditioning::cholesky, 3, true},
                      Case{"SolidMultigrid", Preconditioning::multigrid, 3, true},
                      Case{"SolidMultigridWithoutSpins", Preconditioning::multigrid, 3, false}),
    [](const auto &info) { return std::string(info.param.name); });

TEST(Preconditioner, CholeskyRefusesAnIndefiniteMatrix)
{
  const test::LatticeBody body(2, true, {6, 6});
  const auto matrix = body.matrix([](const Eigen::Vector3d &x) { return x[1] < 0.1; }, -0.5);
  EXPECT_THROW(algebra::make_preconditioner(Preconditioning::cholesky, matrix, body.modes(), 2),
               core::EnvironmentError);
}

TEST(Preconditioner, AutomaticGoesBySize)
{
  const auto all = [](const Eigen::Vector3d &) { return true; };
  const auto name = [&](const test::LatticeBody &body, int dim) {
    return std::string(algebra::make_preconditioner(Preconditioning::automatic, body.matrix(all),
                                                    body.modes(), dim)
                           ->name());
  };
  EXPECT_EQ(name({2, true, {80, 80}}, 2), "Cholesky");
  EXPECT_EQ(name({2, true, {84, 84}}, 2), "multigrid");
  EXPECT_EQ(name({3, true, {5, 5, 5}}, 3), "Cholesky");
  EXPECT_EQ(name({3, true, {6, 6, 6}}, 3), "multigrid");
}

// A run that is resumed makes its preconditioner anew.
TEST(Preconditioner, TheSameMatrixGivesTheSameBits)
{
  const auto bottom = [](const Eigen::Vector3d &x) { return x[1] < 0.1; };
  const test::LatticeBody body(2, true, {30, 30});
  const auto matrix = body.matrix(bottom);
  const VectorXd r = VectorXd::Random(matrix.n_unknowns());
  for (const auto kind : {Preconditioning::cholesky, Preconditioning::multigrid}) {
    VectorXd first, second;
    const auto one = algebra::make_preconditioner(kind, matrix, body.modes(), 2);
    one->apply(r, first);
    one->apply(r, second);
    EXPECT_EQ((first - second).norm(), 0) << one->name();
    algebra::make_preconditioner(kind, matrix, body.modes(), 2)->apply(r, second);
    EXPECT_EQ((first - second).norm(), 0) << one->name();
  }
}
} // namespace
