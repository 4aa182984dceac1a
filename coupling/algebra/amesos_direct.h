// Trilinos' direct solver (KLU) behind the two verbs of the overlap's systems.
#pragma once

#include "coupling/algebra/linear_solver.h"

namespace ligament::coupling
{
std::unique_ptr<LinearSolver> make_amesos_direct();
} // namespace ligament::coupling
