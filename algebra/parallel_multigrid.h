// Algebraic multigrid whose levels are shared out among the ranks of a job. One of them has the
// matrix and asks for solutions; the others do their part.
#pragma once

#include "algebra/preconditioner.h"
#include "core/ranks.h"

namespace ligament::algebra
{
/// make_multigrid() on the first rank, by all of them, the others being in serve_multigrid() until
/// they are dismissed. Each has contiguous rows, and aggregates do not cross from one to another:
/// the solutions differ from those of one process, within the tolerance that they are sought to.
/// Fewer than 1000 block rows for each rank are left to the first one. The ranks are all of the
/// job's. Throws core::EnvironmentError where ML fails; the others may then wait for what never
/// comes, and the job must end.
std::unique_ptr<Preconditioner> make_parallel_multigrid(const BlockMatrix &matrix,
                                                        const Eigen::MatrixXd &modes,
                                                        const core::Ranks &ranks);

/// On all ranks but the first: their part in what it makes and applies, until it dismisses them.
/// Throws core::EnvironmentError where ML fails.
void serve_multigrid(const core::Ranks &ranks);

/// On the first rank: serve_multigrid() returns on the others. What it has made is not to be
/// applied again, but may be alive. One process has nobody to dismiss.
void dismiss_servers(const core::Ranks &ranks);
} // namespace ligament::algebra
