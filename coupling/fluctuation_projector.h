// Q: what is left of a velocity field of the overlap's particles when the part that the mesh can
// carry is taken out.
#pragma once

#include "coupling/linear_solver.h"
#include "coupling/overlap.h"

namespace ligament::coupling
{
/// Q = 1 - Phi (Phi^T M Phi)^-1 Phi^T M over the members that are not pad (theory.md eq. (C1)).
/// Columns of Phi that the others already span are left out, which does not change Q.
template <int dim>
class FluctuationProjector
{
public:
  FluctuationProjector(const Overlap<dim> &overlap, const particles::Particles<dim> &particles,
                       const std::string &solver);

  /// w <- Q w, in place; one array per component, over `free_members()`.
  void project(Components<dim> &w) const;

  /// Indices into Overlap::members of the members that are not pad.
  const std::vector<int> &free_members() const { return free_; }

private:
  static constexpr int n_cell_nodes = Overlap<dim>::n_cell_nodes;
  std::vector<int> free_;
  std::vector<double> mass_;                             // kg, of the free members
  std::vector<std::array<int, n_cell_nodes>> nodes_;     // unknowns; left-out ones: n_unknowns_
  std::vector<std::array<double, n_cell_nodes>> value_;  // shape functions
  int n_unknowns_ = 0;
  std::unique_ptr<LinearSolver> solver_;
  mutable Eigen::MatrixXd right_, padded_;
};
} // namespace ligament::coupling
