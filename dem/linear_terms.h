// The quadratic term of a bond about the reference.
#pragma once

#include "dem/laws/linear_bond.h"
#include "particles/particle_force.h"

namespace ligament::dem
{
/// All of the term but the stiffness of the opening, N/m, which is left for the caller.
template <int dim>
void set_bond_rows(const Bond<dim> &b, const particles::Particles<dim> &p,
                   particles::QuadraticTerm<dim> &term)
{
  constexpr int dofs = n_particle_dofs<dim>, spins = n_spins<dim>;
  term.kind = particles::QuadraticTerm<dim>::Kind::bond;
  term.location = get(p.reference, b.i) + b.lever_i;
  term.members = {b.i, b.j};
  term.rows.setZero(dim + spins, 2 * dofs);
  term.rows.template topLeftCorner<dim, dofs>() = opening_rows<dim>(b.lever_i, -1);
  term.rows.template topRightCorner<dim, dofs>() = opening_rows<dim>(b.lever_j, 1);
  term.rows.template block<spins, spins>(dim, dim) = -bending_rows(b);
  term.rows.template block<spins, spins>(dim, dofs + dim) = bending_rows(b);
  term.stiffness.resize(dim + spins);
  term.stiffness.tail(spins) = bending_stiffness(b);
}
} // namespace ligament::dem
