// The equations of the patch fit, never assembled: blocks of cells with their symmetric
// corrections, and the least-norm solution by Krylov methods on two levels.
#pragma once

#include "coupling/operators/coarse_matrix.h"
#include "coupling/overlap.h"

#include <Eigen/SparseCholesky>

#include <memory>

namespace ligament::coupling
{
// ns: number of unit states that are fitted, the strains or all displacement gradients
// (unit_gradient).

/// Forces on nodes under unit states, N: one row per state; columns node by node, component by
/// component.
template <int ns>
using StateForces = Eigen::Matrix<double, ns, Eigen::Dynamic>;
template <int ns>
using StateMatrix = Eigen::Matrix<double, ns, ns>;

/// Motions of the nodes of a block, shared by blocks of equal shape; rows are node by node,
/// component by component. Where all gradients are fitted, rotations are among the affine motions
/// and translations alone are rigid.
struct PatchBasis
{
  Eigen::MatrixXd place;       // m, one column per node, against the node in the middle
  Eigen::MatrixXd homogeneous; // Q, orthonormal: rigid and affine motions
  Eigen::MatrixXd strain;      // Q^T P_a, 1/m: P_a = Q strain (theory.md eq. (C8))
};

/// The overlap cells that follow one node and their part of the correction Z. Its forces under the
/// unit states are P_a S + P_n H.
template <int dim, int ns>
struct PatchBlock
{
  std::vector<int> nodes; // near nodes
  double volume;          // m^3
  double length;          // m, h_b: smallest edge of the cells
  std::shared_ptr<const PatchBasis> basis;
  StateMatrix<ns> s = StateMatrix<ns>::Zero(); // S, N m
  StateForces<ns> h;                           // (P_n H)^T, N

  /// Its part of Z, N/m.
  Eigen::MatrixXd correction() const;
};

/// One block around every node inside the overlap: a star of 2^dim cells, and of more beside
/// hanging nodes.
template <int dim, int ns>
std::vector<PatchBlock<dim, ns>> make_patch_blocks(const Overlap<dim> &overlap, double thickness);

/// G x = R with x the S/V_b and H/(V_b/h_b) of all blocks, only at the states that each node
/// admits.
template <int dim, int ns>
class PatchEquations
{
public:
  using Field = StateForces<ns>;

  /// `states`: per near node its admissible states, orthonormal columns; none outside the overlap.
  PatchEquations(std::vector<PatchBlock<dim, ns>> &blocks,
                 const std::vector<Eigen::MatrixXd> &states, const Overlap<dim> &overlap);

  /// Leaves only the admissible states.
  void restrict_to_states(Field &field) const;

  /// Sets S and H of least norm with G x = right, to round-off, for a restricted `right` in the
  /// range of G (forces that balance); returns what is left of it.
  Field solve(const Field &right);

private:
  using Method = Field (PatchEquations::*)(const Field &right, double tolerance) const;

  Field refine(const Field &right, Method method);
  void make_coarse_space(const Overlap<dim> &overlap);
  void make_hats(const Overlap<dim> &overlap);
  void factorize_coarse_space();
  void add_coarse_share(const PatchBlock<dim, ns> &block, CoarseMatrix<dim * ns> &sum) const;
  void add_share_of_strains(const PatchBlock<dim, ns> &block, const std::vector<int> &used,
                            CoarseMatrix<dim * ns> &sum) const;
  void add_share_of_gradients(const PatchBlock<dim, ns> &block, const std::vector<int> &used,
                              CoarseMatrix<dim * ns> &sum) const;
  void add_transposed(const Field &y);
  Field forces() const;
  Field apply(const Field &y) const;
  Field precondition(const Field &r) const;
  Field conjugate_residuals(const Field &right, double tolerance) const;
  Field conjugate_gradients(const Field &right, double tolerance) const;

  std::vector<PatchBlock<dim, ns>> &blocks_;
  std::vector<StateMatrix<ns>> projectors_; // per near node, on its states
  Eigen::VectorXd diagonal_;                // per near node: sum of (V_b/h_b)^2
  // Second level: every node for itself, or hats over the overlap; per node the numbers and values
  // of those that reach it.
  std::vector<std::vector<std::pair<int, double>>> hats_;
  int n_hats_ = 0;
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> coarse_;
  Eigen::VectorXd coarse_scale_;
};
} // namespace ligament::coupling
