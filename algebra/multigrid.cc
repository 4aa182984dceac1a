#include "algebra/multigrid.h"

#include "algebra/epetra_rows.h"
#include "algebra/inert_unknowns.h"
#include "algebra/multigrid_settings.h"
#include "core/check.h"

#include <Epetra_Map.h>
#include <Epetra_MpiComm.h>
#include <Epetra_Vector.h>
#include <ml_utils.h>
#include <mpi.h>

#include <cstdlib>
#include <limits>

namespace ligament::algebra
{
namespace
{
/// ML calls MPI even on one process.
void need_mpi()
{
  int is_there = 0, was_there = 0;
  MPI_Initialized(&is_there);
  if (is_there)
    return;
  MPI_Finalized(&was_there);
  core::require<core::EnvironmentError>(!was_there, "multigrid: MPI has been shut down already");
  // A process on its own: no daemon beside it (Open MPI; others and mpirun don't ask).
  setenv("OMPI_MCA_ess_singleton_isolated", "1", false);
  int threads = 0;
  core::require<core::EnvironmentError>(
      MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &threads) == MPI_SUCCESS,
      "multigrid: MPI doesn't start");
  // Who starts it ends it.
  std::atexit([] {
    int ended = 0;
    MPI_Finalized(&ended);
    if (!ended)
      MPI_Finalize();
  });
}

class Multigrid : public Preconditioner
{
public:
  Multigrid(const BlockMatrix &matrix, const Eigen::MatrixXd &modes)
      : modes_(modes), communicator_(MPI_COMM_SELF),
        map_(int(matrix.n_unknowns()), 0, communicator_), rows_(matrix.copy(), map_),
        levels_(rows_, multigrid_settings(matrix.block_size(), modes_), false), inert_(matrix)
  {
    // Eigenvalues are estimated from a random vector on: the same matrix, the same levels.
    ML_set_random_seed(1);
    core::require<core::EnvironmentError>(levels_.ComputePreconditioner() == 0,
                                          "multigrid: ML cannot make its levels");
  }

  void apply(const Eigen::VectorXd &r, Eigen::VectorXd &z) const override
  {
    inert_.pass_by(r, z, [&](const Eigen::VectorXd &from, Eigen::VectorXd &to) {
      const Epetra_Vector right(View, map_, const_cast<double *>(from.data()));
      Epetra_Vector result(View, map_, to.data());
      const int failed = levels_.ApplyInverse(right, result);
      core::require<core::EnvironmentError>(failed == 0, "multigrid: ML failed");
    });
  }

  const char *name() const override { return "multigrid"; }

private:
  Eigen::MatrixXd modes_; // ML keeps a pointer
  Epetra_MpiComm communicator_;
  Epetra_Map map_;
  EpetraRows rows_;
  ML_Epetra::MultiLevelPreconditioner levels_;
  InertUnknowns inert_;
};
} // namespace

std::unique_ptr<Preconditioner> make_multigrid(const BlockMatrix &matrix,
                                               const Eigen::MatrixXd &modes)
{
  core::require<core::EnvironmentError>(matrix.n_unknowns() < std::numeric_limits<int>::max(),
                                        "multigrid: too many unknowns");
  core::require(modes.rows() == matrix.n_unknowns() && modes.cols() > 0,
                "multigrid: the modes don't fit the matrix");
  need_mpi();
  return std::make_unique<Multigrid>(matrix, modes);
}
} // namespace ligament::algebra
