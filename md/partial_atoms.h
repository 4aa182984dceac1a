// A part of the energy of atoms: every pair and every embedding with a share of its own.
#pragma once

#include "md/bond_view.h"
#include "md/partial_kernel.h"
#include "md/potential.h"
#include "particles/particle_force.h"

namespace ligament::md
{
/// sum_pairs s_b [phi + F'_i f_ij + F'_j f_ji] + sum_i s_i [F_i(rho_i) - F'_i rho_i], less the same
/// at rest, with the F' that the atoms of the whole body have there: its second derivatives at rest
/// are those of the terms (M6), each times its share; in the crystal F' = 0. At any deformation
/// (theory.md (M9)).
template <int dim>
class PartialAtoms : public particles::PartialForce<dim>
{
public:
  /// Between atoms of the part. Atoms whose embedding has a share need all their neighbours.
  struct SharedPair
  {
    int i, j;
    Vector<dim> reference; // m, from i to j or its image
    double share;          // of phi
    double tilt_i, tilt_j; // share times F' of i and of j
  };

  struct SharedAtom
  {
    int species;
    double share;      // of its embedding
    double rest_slope; // F' at rest, J
  };

  PartialAtoms(const Potential &potential, std::vector<SharedPair> pairs,
               std::vector<SharedAtom> atoms);

  double compute(particles::Particles<dim> &atoms) override;
  /// By vectors of pairs, where all atoms are of one species; else by plain loops.
  void compute_forces(particles::Particles<dim> &atoms) override;

private:
  Bond<dim> bond_of(const SharedPair &p, const particles::Particles<dim> &atoms) const;
  void read_displacements(const particles::Particles<dim> &atoms);
  double change_densities(const particles::Particles<dim> &atoms);
  double change_densities_plainly(const particles::Particles<dim> &atoms);
  void compute_plainly(particles::Particles<dim> &atoms) const;
  void lay_out();
  PartialArrays arrays();

  Potential potential_;
  std::vector<SharedPair> pairs_;
  std::vector<SharedAtom> atoms_;
  std::vector<double> rest_density_;
  std::vector<double> density_; // rho, or less that at rest
  std::vector<double> slope_;   // s (F' less that at rest)

  // Of vectors of pairs, those in range at rest first.
  bool is_of_one_kind_ = false;
  PartialPasses passes_;
  std::vector<PairPiece> table_;
  std::vector<int> i_, j_;
  std::array<std::vector<double>, 3> places_;                    // m
  std::vector<double> share_, tilts_, rest_, pull_, pair_slope_; // rest: distance, m
  std::vector<double> atom_records_, force_;
  std::array<double, 8> pair_energy_ = {}; // J
};
} // namespace ligament::md
