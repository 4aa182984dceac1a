#include "coupling/algebra/linear_solver.h"

#include "core/check.h"
#include "coupling/algebra/amesos_direct.h"
#include "coupling/algebra/tiled_cholesky.h"

namespace ligament::coupling
{
std::unique_ptr<LinearSolver> make_linear_solver(const std::string &name)
{
  if (name == "amesos")
    return make_amesos_direct();
  core::require(name == "eigen", "unknown overlap solver \"" + name + "\": use eigen or amesos");
  return std::make_unique<TiledCholesky>();
}
} // namespace ligament::coupling
