// Bonds of a neighbour list as vectors between atoms, with all digits of small displacements.
#pragma once

#include "md/neighbour_list.h"
#include "particles/particles.h"

namespace ligament::md
{
/// A pair within the cut-off now or in the reference.
template <int dim>
struct Bond
{
  int i, j;
  Vector<dim> reference; // m, from i to j or its image
  Vector<dim> moved;     // m, what it has become more than that
  Vector<dim> present;   // m, their sum
  double length;         // m, of the present one

  /// Present less reference length; keeps the digits of small displacements.
  double longer() const { return moved.dot(2 * reference + moved) / (length + reference.norm()); }
};

/// visit(bond) for every pair of the list that is nearer than the cut-off now or, with
/// `or_reference`, in the reference. The vector is that of the reference plus the difference of the
/// displacements: rounding of places does not enter.
template <int dim, typename Visit>
void for_each_bond(const NeighbourList &list, const particles::Particles<dim> &atoms,
                   const Vector<dim> &period, bool or_reference, Visit &&visit)
{
  const double limit2 = list.cutoff() * list.cutoff();
  list.for_each_pair([&](int i, int j, const std::array<int, 3> &periods) {
    Bond<dim> bond;
    bond.i = i;
    bond.j = j;
    double r2 = 0, reference2 = 0;
    for (int c = 0; c < dim; ++c) {
      bond.reference[c] = atoms.reference[c][j] - atoms.reference[c][i] + periods[c] * period[c];
      bond.moved[c] = atoms.displacement[c][j] - atoms.displacement[c][i];
      bond.present[c] = bond.reference[c] + bond.moved[c];
      r2 += bond.present[c] * bond.present[c];
      reference2 += bond.reference[c] * bond.reference[c];
    }
    if (r2 < limit2 || (or_reference && reference2 < limit2)) {
      bond.length = std::sqrt(r2);
      visit(bond);
    }
  });
}
} // namespace ligament::md
