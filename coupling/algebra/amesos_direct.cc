#include "coupling/algebra/amesos_direct.h"

#include "core/check.h"

#include <Amesos.h>
#include <Amesos_BaseSolver.h>
#include <Epetra_CrsMatrix.h>
#include <Epetra_LinearProblem.h>
#include <Epetra_Map.h>
#include <Epetra_MultiVector.h>
#include <Epetra_SerialComm.h>

namespace ligament::coupling
{
namespace
{
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

std::unique_ptr<LinearSolver> make_amesos_direct()
{
  return std::make_unique<AmesosDirect>();
}
} // namespace ligament::coupling
