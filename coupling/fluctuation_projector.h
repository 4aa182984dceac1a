// Q: what is left of a velocity field of the overlap's particles when the part that the mesh can
// carry is taken out.
#pragma once

#include "coupling/linear_solver.h"
#include "coupling/transfer.h"

namespace ligament::coupling
{
/// Q = 1 - Phi (Phi^T M Phi)^-1 Phi^T M over the members that are not pad (theory.md eq. (C1)).
/// Columns of Phi that the others already span are left out, which does not change Q.
template <int dim>
class FluctuationProjector
{
public:
  FluctuationProjector(const Overlap<dim> &overlap, const Transfer<dim> &transfer,
                       const particles::Particles<dim> &particles, const std::string &solver);

  /// w <- Q w, in place; one array per component in the order of the transfer's members.
  void project(Components<dim> &w) const;

private:
  const Transfer<dim> &transfer_;
  std::vector<int> nodes_; // near nodes that are unknowns
  std::unique_ptr<LinearSolver> solver_;
  mutable std::vector<double> unknowns_; // dim per unknown
  mutable Nodal<dim> nodal_;
};
} // namespace ligament::coupling
