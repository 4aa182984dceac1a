#include "coupling/linear_solver.h"

#include "core/check.h"

#include <Amesos.h>
#include <Amesos_BaseSolver.h>
#include <Eigen/SparseCholesky>
#include <Epetra_CrsMatrix.h>
#include <Epetra_LinearProblem.h>
#include <Epetra_Map.h>
#include <Epetra_MultiVector.h>
#include <Epetra_SerialComm.h>

#include <vector>

namespace ligament::coupling
{
namespace
{
// P A P^T = L L^T by Eigen; the sweeps are our own, because Eigen's go through one right-hand side
// after the other and read L anew for each.
class EigenCholesky : public LinearSolver
{
public:
  void factorise(const Eigen::SparseMatrix<double> &matrix) override
  {
    const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> cholesky(matrix);
    core::require(cholesky.info() == Eigen::Success,
                  "an overlap system is not positive definite: the overlap holds too few particles "
                  "for its cells; raise /far_field/cell_size or /coupling/overlap_cells");
    lower_ = cholesky.matrixL().nestedExpression();
    lower_.makeCompressed();
    const auto &permutation = cholesky.permutationP().indices();
    place_.assign(permutation.data(), permutation.data() + permutation.size());
    inverse_diagonal_.resize(place_.size());
    negative_.clear();
    for (std::size_t j = 0; j < place_.size(); ++j)
      inverse_diagonal_[j] = 1 / lower_.valuePtr()[lower_.outerIndexPtr()[j]];
    work_.resize(3 * place_.size());
  }

  // Such a matrix has P A P^T = L D L^T without pivoting, with D of both signs: kept as
  // (L |D|^1/2) sign(D) (L |D|^1/2)^T.
  void factorise_constrained(const Eigen::SparseMatrix<double> &matrix) override
  {
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> cholesky(matrix);
    const Eigen::VectorXd d = cholesky.vectorD();
    core::require(cholesky.info() == Eigen::Success && d.cwiseAbs().minCoeff() > 0,
                  "the multipliers of the overlap depend on each other; raise "
                  "/far_field/cell_size or /coupling/overlap_cells");
    const Eigen::SparseMatrix<double> unit = cholesky.matrixL();
    lower_ = unit * d.cwiseAbs().cwiseSqrt().asDiagonal();
    lower_.makeCompressed();
    const auto &permutation = cholesky.permutationP().indices();
    place_.assign(permutation.data(), permutation.data() + permutation.size());
    inverse_diagonal_ = d.cwiseAbs().cwiseSqrt().cwiseInverse();
    work_.resize(3 * place_.size());
    negative_.clear();
    for (int j = 0; j < d.size(); ++j)
      if (d[j] < 0)
        negative_.push_back(j);
  }

  void solve(double *x, int n_columns) const override
  {
    if (n_columns == 1)
      sweep<1>(x);
    else if (n_columns == 2)
      sweep<2>(x);
    else
      sweep<3>(x);
  }

private:
  template <int columns>
  void sweep(double *x) const
  {
    const int n = int(place_.size());
    const int *start = lower_.outerIndexPtr(), *row = lower_.innerIndexPtr();
    const double *value = lower_.valuePtr();
    double *y = work_.data();
    for (int i = 0; i < n; ++i)
      for (int c = 0; c < columns; ++c)
        y[place_[i] * columns + c] = x[i * columns + c];
    for (int j = 0; j < n; ++j) {
      double solved[columns];
      for (int c = 0; c < columns; ++c)
        solved[c] = y[j * columns + c] *= inverse_diagonal_[j];
      for (int k = start[j] + 1; k < start[j + 1]; ++k)
        for (int c = 0; c < columns; ++c)
          y[row[k] * columns + c] -= value[k] * solved[c];
    }
    for (const int j : negative_)
      for (int c = 0; c < columns; ++c)
        y[j * columns + c] *= -1;
    for (int j = n - 1; j >= 0; --j) {
      double sum[columns];
      for (int c = 0; c < columns; ++c)
        sum[c] = y[j * columns + c];
      for (int k = start[j] + 1; k < start[j + 1]; ++k)
        for (int c = 0; c < columns; ++c)
          sum[c] -= value[k] * y[row[k] * columns + c];
      for (int c = 0; c < columns; ++c)
        y[j * columns + c] = sum[c] * inverse_diagonal_[j];
    }
    for (int i = 0; i < n; ++i)
      for (int c = 0; c < columns; ++c)
        x[i * columns + c] = y[place_[i] * columns + c];
  }

  Eigen::SparseMatrix<double> lower_; // its first entry in each column is the diagonal
  std::vector<int> place_;            // of an unknown in the order of elimination
  Eigen::VectorXd inverse_diagonal_;
  std::vector<int> negative_; // entries of D below 0
  mutable std::vector<double> work_;
};

class AmesosDirect : public LinearSolver
{
public:
  void factorise(const Eigen::SparseMatrix<double> &matrix) override
  {
    const int n = int(matrix.rows());
    map_ = std::make_unique<Epetra_Map>(n, 0, comm_);
    matrix_ = std::make_unique<Epetra_CrsMatrix>(Copy, *map_, 0);
    // Symmetric: a column is a row.
    for (int row = 0; row < n; ++row) {
      const int begin = matrix.outerIndexPtr()[row], end = matrix.outerIndexPtr()[row + 1];
      matrix_->InsertGlobalValues(row, end - begin, matrix.valuePtr() + begin,
                                  matrix.innerIndexPtr() + begin);
    }
    matrix_->FillComplete();
    problem_ = std::make_unique<Epetra_LinearProblem>();
    problem_->SetOperator(matrix_.get());
    solver_.reset(Amesos().Create("Amesos_Klu", *problem_));
    core::require<core::EnvironmentError>(solver_ != nullptr, "this Trilinos has no Amesos_Klu");
    core::require(
        solver_->SymbolicFactorization() == 0 && solver_->NumericFactorization() == 0,
        "an overlap system is singular: the overlap holds too few particles for its cells; "
        "raise /far_field/cell_size or /coupling/overlap_cells");
  }

  void factorise_constrained(const Eigen::SparseMatrix<double> &matrix) override
  {
    factorise(matrix); // LU: signs don't matter
  }

  void solve(double *x, int n_columns) const override
  {
    const int n = map_->NumMyElements();
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::MatrixXd columns = Eigen::Map<const Rows>(x, n, n_columns);
    Epetra_MultiVector right(Copy, *map_, columns.data(), n, n_columns);
    Epetra_MultiVector left(View, *map_, columns.data(), n, n_columns);
    problem_->SetLHS(&left);
    problem_->SetRHS(&right);
    core::require<core::GuardStop>(solver_->Solve() == 0, "Amesos failed in the overlap");
    Eigen::Map<Rows>(x, n, n_columns) = columns;
  }

private:
  Epetra_SerialComm comm_;
  std::unique_ptr<Epetra_Map> map_;
  std::unique_ptr<Epetra_CrsMatrix> matrix_;
  std::unique_ptr<Epetra_LinearProblem> problem_;
  std::unique_ptr<Amesos_BaseSolver> solver_;
};
} // namespace

std::unique_ptr<LinearSolver> make_linear_solver(const std::string &name)
{
  if (name == "amesos")
    return std::make_unique<AmesosDirect>();
  core::require(name == "eigen", "unknown overlap solver \"" + name + "\": use eigen or amesos");
  return std::make_unique<EigenCholesky>();
}
} // namespace ligament::coupling
