// Which nodes of the overlap the particles can tell apart.
#pragma once

#include "coupling/overlap.h"

#include <Eigen/SparseCore>

namespace ligament::coupling
{
/// Marks the columns of a Gram matrix that the columns before them don't span: banded Cholesky that
/// passes over pivots below 1e-10 of the largest diagonal entry. The order of the unknowns decides
/// about its cost: see nodes_along_overlap.
std::vector<char> independent_columns(const Eigen::SparseMatrix<double> &gram);

/// Near nodes in the order of their place along the overlap's longest direction: a narrow band.
template <int dim>
std::vector<int> nodes_along_overlap(const Overlap<dim> &overlap);
} // namespace ligament::coupling
