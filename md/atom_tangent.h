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

/// Who is whose neighbour in the reference.
template <int dim>
class ReferenceBonds
{
public:
  ReferenceBonds(const AtomBody<dim> &body, const particles::Particles<dim> &atoms);

  /// visit(bond)
  template <typename Visit>
  void for_each(Visit &&visit) const
  {
    for_each_bond<dim>(list_, at_rest_, period_, false, visit);
  }
  Vector<dim> place(int i) const { return get(at_rest_.reference, i); }
  long n_pairs() const { return list_.n_pairs(); }

private:
  Vector<dim> period_;
  particles::Particles<dim> at_rest_;
  NeighbourList list_;
};

/// Bonds of the reference with the densities that the atoms have there.
template <int dim>
class AtomTangent
{
public:
  AtomTangent(const AtomBody<dim> &body, const particles::Particles<dim> &atoms);

  double density(int i) const { return density_[i]; }

  /// Terms in the order of pairs, then of atoms, (M6); those that one of these atoms enters
  /// (ascending; null: all). They have no columns of rotations.
  void add_terms(const std::function<void(const particles::QuadraticTerm<dim> &)> &add,
                 const std::vector<int> *of) const;

  /// Keeps what apply() else finds anew in every call, unless that would fill the memory.
  void keep_stiffness();

  /// Overwrites `force` (N) by minus the stiffness times the displacements (m).
  void apply(const Components<dim> &displacement, Components<dim> &force) const;

private:
  struct Stiffness
  {
    double along, across;    // N/m
    double slope_i, slope_j; // f' at i and at j, per m
  };
  struct KeptPair
  {
    int i, j;
    Vector<dim> reference;
    double length;
    Stiffness stiffness;
  };
  Stiffness stiffness(const Bond<dim> &bond) const;
  /// visit(bond, stiffness), the bonds at rest
  template <typename Visit>
  void for_each_pair(Visit &&visit) const;
  double embedding_stiffness(int i) const; // F'' times the weight, J

  const AtomBody<dim> &body_;
  ReferenceBonds<dim> bonds_;
  std::vector<KeptPair> kept_;
  std::vector<double> density_, slope_, curvature_; // rho, F' and F'' of each atom
};

/// 2/omega in s, omega the largest frequency of the linearised body by Lanczos iteration, raised
/// by 1 %; deterministic. Held atoms do not move. Throws core::InputError where none is free.
template <int dim>
double stable_step(AtomTangent<dim> tangent, const particles::Particles<dim> &atoms);
} // namespace ligament::md
