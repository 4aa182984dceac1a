// Algebraic multigrid by smoothed aggregation.
#pragma once

#include "algebra/preconditioner.h"

namespace ligament::algebra
{
std::unique_ptr<Preconditioner> make_multigrid(const BlockMatrix &matrix,
                                               const Eigen::MatrixXd &modes);
} // namespace ligament::algebra
