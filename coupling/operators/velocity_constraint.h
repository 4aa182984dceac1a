// Multipliers that tie the velocities of particles and mesh in the overlap.
#pragma once

#include "coupling/algebra/linear_solver.h"
#include "coupling/operators/transfer.h"
#include "coupling/scheme.h"

namespace ligament::coupling
{
/// Makes the gap v - Phi V of the overlap's particles invisible to the multipliers' test functions
/// (theory.md eqs. (B3) to (B5)): nodal functions with the particles' volumes as quadrature, or one
/// per particle. What it adds to the motion is M^-1 times the constraint's forces: momentum is
/// kept.
template <int dim>
class VelocityConstraint
{
public:
  /// shares: a of the members in the transfer's order, which holds the unweighted masses m; their
  /// present masses are a m. mass: of the near nodes, kg, diagonal for `xiao_belytschko_lumped`.
  /// multiplier_cells: edge of the
  /// multipliers' hats in cells, 1 for the shape functions of the mesh.
  VelocityConstraint(Scheme scheme, const Overlap<dim> &overlap, const Transfer<dim> &transfer,
                     const std::vector<double> &shares, const Eigen::SparseMatrix<double> &mass,
                     int multiplier_cells, Solver solver);

  /// Corrects velocities of members (transfer's order) and near nodes, in m/s.
  void project(Components<dim> &v, Nodal<dim> &nodal) const;

  int n_multipliers() const { return int(tests_.rows()); }

private:
  using Matrix = Eigen::SparseMatrix<double>;

  void make_tests(const Overlap<dim> &overlap, const Matrix &gram, int multiplier_cells);
  void set_multipliers(Components<dim> &v, const Nodal<dim> &lambda) const;

  const Scheme scheme_;
  const Transfer<dim> &transfer_;
  std::vector<double> shares_;
  Matrix gram_;             // Phi^T m Phi
  Matrix tests_;            // R: multipliers x near nodes
  Eigen::VectorXd row_sum_; // of the multipliers' matrix, lumped scheme only
  std::unique_ptr<LinearSolver> solver_;
  mutable Components<dim> gap_;
  mutable Nodal<dim> nodal_, unknowns_;
};
} // namespace ligament::coupling
