#include "coupling/algebra/linear_solver.h"

#include "coupling/algebra/amesos_direct.h"
#include "coupling/algebra/tiled_cholesky.h"

namespace ligament::coupling
{
std::unique_ptr<LinearSolver> make_linear_solver(Solver solver)
{
  if (solver == Solver::amesos)
    return make_amesos_direct();
  return std::make_unique<TiledCholesky>();
}
} // namespace ligament::coupling
