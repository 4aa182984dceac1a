// The rows of a block matrix, raised on the diagonal, as Trilinos asks for them.
#pragma once

#include "algebra/block_matrix.h"
#include "algebra/raised_diagonal.h"

#include <Epetra_BasicRowMatrix.h>
#include <Epetra_Comm.h>
#include <Epetra_Import.h>
#include <Epetra_Map.h>
#include <Epetra_Vector.h>

#include <memory>
#include <utility>

namespace ligament::algebra
{
class EpetraRows : public Epetra_BasicRowMatrix
{
public:
  /// Of a process that has all rows.
  EpetraRows(BlockMatrix matrix, const Epetra_Map &rows) : EpetraRows(std::move(matrix), rows, rows)
  {
  }

  /// Of one that has some: columns are those of its own rows, in their order, then others. All
  /// processes of the map make theirs together.
  EpetraRows(BlockMatrix matrix, const Epetra_Map &rows, const Epetra_Map &columns)
      : Epetra_BasicRowMatrix(rows.Comm()), matrix_(std::move(matrix))
  {
    SetMaps(rows, columns);
    if (rows.Comm().NumProc() > 1) {
      importer_ = std::make_unique<Epetra_Import>(columns, rows);
      at_hand_ = std::make_unique<Epetra_Vector>(columns);
    }
    matrix_.for_each_diagonal([](double &entry) { entry = raised(entry); });
  }

  int NumMyRowEntries(int row, int &n) const override
  {
    const int b = matrix_.block_size();
    n = b * int(matrix_.row_start()[row / b + 1] - matrix_.row_start()[row / b]);
    return 0;
  }

  int ExtractMyRowCopy(int row, int length, int &n, double *values, int *columns) const override
  {
    NumMyRowEntries(row, n);
    if (n > length)
      return -1;
    const int b = matrix_.block_size(), r = row % b;
    for (auto k = matrix_.row_start()[row / b]; k < matrix_.row_start()[row / b + 1]; ++k)
      for (int c = 0; c < b; ++c) {
        *values++ = matrix_.value()[k * b * b + r * b + c];
        *columns++ = matrix_.column()[k] * b + c;
      }
    return 0;
  }

  int Multiply(bool, const Epetra_MultiVector &x, Epetra_MultiVector &y) const override
  {
    for (int k = 0; k < x.NumVectors(); ++k) {
      if (importer_) {
        const Epetra_Vector own(View, OperatorDomainMap(), x[k]);
        if (const int failed = at_hand_->Import(own, *importer_, Insert))
          return failed;
      }
      matrix_.multiply(importer_ ? at_hand_->Values() : x[k], y[k]);
    }
    return 0;
  }

  const Epetra_Import *RowMatrixImporter() const override { return importer_.get(); }
  const Epetra_Import *Importer() const override { return importer_.get(); }

  int ExtractDiagonalCopy(Epetra_Vector &diagonal) const override
  {
    Eigen::Map<Eigen::VectorXd>(diagonal.Values(), diagonal.MyLength()) = matrix_.diagonal();
    return 0;
  }

  // Entry by entry: only Epetra's own loops ask, which are replaced above.
  int ExtractMyEntryView(int, double *&, int &, int &) override { return -1; }
  int ExtractMyEntryView(int, double const *&, int &, int &) const override { return -1; }

private:
  BlockMatrix matrix_;
  std::unique_ptr<Epetra_Import> importer_; // none: of one process
  std::unique_ptr<Epetra_Vector> at_hand_;  // x of all columns
};
} // namespace ligament::algebra
