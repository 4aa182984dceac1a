// The energy of atoms: pairs, and each atom in the density that its neighbours make. One evaluation
// serves forces, tangent and the stress of the crystal alike.
#pragma once

#include "md/spline.h"

#include <string>
#include <vector>

namespace ligament::md
{
struct Species
{
  std::string name;
  double mass = 0;              // kg
  double lattice_parameter = 0; // m, as a file says; 0: nobody does
  std::string lattice = {};     // "fcc", "bcc", ... likewise
};

/// "Cu, Ni, Al".
std::string list_of_names(const std::vector<std::string> &names);

/// Two atoms i and j as functions of their distance.
struct BondJets
{
  Jet pair;         // phi, J
  Jet density_at_i; // what j adds to the density at i
  Jet density_at_j; // and i to that at j
};

/// E = sum_{i<j} phi_ab(r_ij) + sum_i F_a(rho_i), rho_i = sum_j f_ab(r_ij), theory.md (M1): a is
/// the species of i, b that of j. Energies in J, lengths in m; densities in any unit. phi and f
/// are splines on one grid, whose value and slope vanish at the cut-off.
class Potential
{
public:
  /// n species; pair and density have n x n entries, that of (a, b) at a n + b; pair is symmetric,
  /// density (a, b) is what an atom of b adds at one of a. Embedding has n, or none for pair
  /// potentials, which have no density either. Throws core::InputError where these numbers or the
  /// grids do not fit, and for masses that are not positive.
  Potential(std::vector<Species> species, std::vector<Spline> pair, std::vector<Spline> density,
            std::vector<Spline> embedding);

  int n_species() const { return int(species_.size()); }
  const Species &species(int a) const { return species_[a]; }
  /// Number of the species of this name; throws core::InputError where there is none.
  int find_species(const std::string &name) const;

  double cutoff() const { return pair_[0].end(); } // m
  bool has_embedding() const { return !embedding_.empty(); }

  BondJets bond(int a, int b, double distance) const;
  /// F_a and its derivatives; 0 for pair potentials.
  Jet embedding(int a, double density) const;

  /// The same energy of every configuration with F_a' = 0 at the given densities, one per species:
  /// (M2).
  Potential normal_form(const std::vector<double> &densities) const;

  const Spline &pair_spline(int a, int b) const { return pair_[a * n_species() + b]; }
  const Spline &density_spline(int at, int of) const { return density_[at * n_species() + of]; }
  const Spline &embedding_spline(int a) const { return embedding_[a]; }

private:
  std::vector<Species> species_;
  std::vector<Spline> pair_, density_, embedding_;
};
} // namespace ligament::md
