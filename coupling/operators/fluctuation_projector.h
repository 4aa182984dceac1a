// Q: what is left of a velocity field of the overlap's particles when the part that the mesh can
// carry is taken out.
#pragma once

#include "coupling/operators/coarse_projection.h"

namespace ligament::coupling
{
/// Q = 1 - Phi (Phi^T M Phi)^-1 Phi^T M over the members that are not pad, M the transfer's masses
/// (theory.md eq. (C4)).
template <int dim>
class FluctuationProjector
{
public:
  FluctuationProjector(const Overlap<dim> &overlap, const Transfer<dim> &transfer, Solver solver);

  /// w <- Q w, in place; one array per component in the order of the transfer's members.
  void project(Components<dim> &w) const;

private:
  const Transfer<dim> &transfer_;
  CoarseProjection<dim> carried_;
  mutable Nodal<dim> nodal_;
};
} // namespace ligament::coupling
