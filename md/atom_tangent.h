// The energy of atoms to second order about the reference: a term per pair, and one per atom.
#pragma once

#include "md/bond_view.h"
#include "md/crack_screen.h"
#include "md/potential.h"
#include "particles/particle_force.h"

#include <functional>

namespace ligament::md
{
/// What a body of atoms is made of.
template <int dim>
struct AtomBody
{
  Potential potential;        // in normal form, where there is a crystal
  std::vector<int> species;   // of each atom
  Vector<dim> period;         // m; 0: none
  std::vector<double> weight; // of each atom's energy; empty: 1
  CrackScreen<dim> screen;    // pairs that cracks have parted

  double weight_of(int i) const { return weight.empty() ? 1 : weight[i]; }
  double weight_of(int i, int j) const { return (weight_of(i) + weight_of(j)) / 2; }
};

/// Bonds of the reference with the densities that the atoms have there.
template <int dim>
class AtomTangent
{
public:
  AtomTangent(const AtomBody<dim> &body, const particles::Particles<dim> &atoms);

  double density(int i) const { return density_[i]; }

  /// Terms in the order of pairs, then of atoms, (M6); those that one of these atoms enters
  /// (ascending; null: all). They have columns of rotations, all 0.
  void add_terms(const std::function<void(const particles::QuadraticTerm<dim> &)> &add,
                 const std::vector<int> *of) const;

  /// visit(bond) of the reference.
  template <typename Visit>
  void for_each_bond(Visit &&visit) const
  {
    md::for_each_bond<dim>(list_, at_rest_, body_.period, false, visit);
  }

  /// Overwrites `force` (N) by minus the stiffness times the displacements (m).
  void apply(const Components<dim> &displacement, Components<dim> &force) const;

private:
  struct Stiffness
  {
    double along, across;    // N/m
    double slope_i, slope_j; // f' at i and at j, per m
  };
  Stiffness stiffness(const Bond<dim> &bond) const;
  /// visit(bond, stiffness)
  template <typename Visit>
  void for_each_pair(Visit &&visit) const;
  double embedding_stiffness(int i) const; // F'' times the weight, J

  const AtomBody<dim> &body_;
  particles::Particles<dim> at_rest_;
  NeighbourList list_;
  std::vector<double> density_, slope_, curvature_; // rho, F' and F'' of each atom
};

/// 2/omega in s, omega the largest frequency of the linearised body by Lanczos iteration, raised
/// by 1 %; deterministic. Held atoms do not move. Throws core::InputError where none is free.
template <int dim>
double stable_step(const AtomTangent<dim> &tangent, const particles::Particles<dim> &atoms);
} // namespace ligament::md
