// The overlap as one of several ranks sees it.
#pragma once

#include "coupling/overlap.h"

namespace ligament::coupling
{
/// An overlap with the particles that its members are.
template <int dim>
struct OverlapView
{
  const Overlap<dim> &overlap;
  const particles::Particles<dim> &particles;
};

/// The same overlap with those of its members alone that are at hand, as these are numbered there:
/// cells, nodes and weights are those of the whole.
template <int dim>
Overlap<dim> overlap_at_hand(const OverlapView<dim> &whole, const particles::Particles<dim> &here);
} // namespace ligament::coupling
