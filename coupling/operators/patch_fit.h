// The patch fit: the smallest symmetric correction of the coarse stiffness with which the coupled
// body carries every uniform strain exactly.
#pragma once

#include "coupling/operators/blended_operators.h"

namespace ligament::coupling
{
struct PatchFit
{
  Eigen::SparseMatrix<double> correction; // Z, N/m, numbered like BlendedOperators::stiffness
  double residual_before; // largest nodal force under a unit state over C11 h^(dim-1), without Z
  double residual;        // the same with Z
  double largest_modulus; // max |S| / (C11 V_b): how much stiffness the fit moves
};

/// Solves for Z = sum over blocks of 2^dim overlap cells (theory.md, "Patch fit"). At nodes that
/// feel a free surface only the strains that leave that surface free of stress are fitted. Fits the
/// states of `operators.residual`: all displacement gradients where bonds bear forces in the
/// reference; then no overlap node may feel a free surface (core::InputError).
template <int dim>
PatchFit fit_patch(const Overlap<dim> &overlap, const BlendedOperators<dim> &operators,
                   const fem::Body<dim> &body);

/// Strains (columns) whose stress is zero on all the given surfaces: all unit strains without any.
template <int dim>
Eigen::MatrixXd admissible_strains(const std::vector<Vector<dim>> &normals,
                                   const Stiffness<dim> &stiffness);
} // namespace ligament::coupling
