// The part of a motion of the overlap's particles that the mesh can carry.
#pragma once

#include "coupling/algebra/linear_solver.h"
#include "coupling/operators/transfer.h"

#include <functional>

namespace ligament::coupling
{
/// x = (Phi^T M Phi)^-1 Phi^T M w over the members that are not pad (theory.md eqs. (C1), (C19)).
/// Columns of Phi that the others already span are left out, which does not change Phi x.
template <int dim>
class CoarseProjection
{
public:
  using Member = typename Overlap<dim>::Member;
  /// mass: entry of M of a member, in kg.
  CoarseProjection(const Overlap<dim> &overlap, const std::function<double(const Member &)> &mass,
                   Solver solver);

  /// Phi^T M w in, x out; rows are near nodes.
  void solve(Nodal<dim> &nodal) const;
  /// Near nodes that carry a motion of their own: the rank of Phi.
  int n_unknowns() const { return int(nodes_.size()); }

private:
  std::vector<int> nodes_; // near nodes that are unknowns
  std::unique_ptr<LinearSolver> solver_;
  mutable std::vector<double> unknowns_; // dim per unknown
};
} // namespace ligament::coupling
