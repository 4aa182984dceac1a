// What atoms of one kind have gained in energy since their reference, by vectors of pairs: a row of
// history takes about as long as the forces of two steps.
#pragma once

#include "md/neighbour_list.h"
#include "md/pair_table.h"
#include "md/partial_kernel.h"
#include "particles/particles.h"

namespace ligament::md
{
/// Keeps the digits of small displacements, as Spline::change() does within an interval; from one
/// interval to the next those of the values. Sums are in the order of the list: same list, same
/// bits.
template <int dim>
class EnergyChange
{
public:
  /// `period` in m, 0 along axes without.
  EnergyChange(const Potential &potential, int species, const Vector<dim> &period);

  /// J, by the pairs of a list that has all those within the cut-off now and in the reference.
  /// `at_rest`: densities there, of each atom.
  double find(const NeighbourList &list, const particles::Particles<dim> &atoms,
              const std::vector<double> &at_rest);

private:
  /// Of the pairs so far, which are forgotten; adds to the changes of densities.
  double pass();
  void add_pair(int i, int j, const Vector<dim> &reference);
  PartialArrays arrays();

  Spline embedding_;
  bool has_embedding_;
  double cutoff_; // m
  Vector<dim> period_;
  std::vector<PairPiece> table_;
  PartialPasses passes_;

  // Of some pairs at a time.
  int n_pairs_ = 0;
  std::vector<int> i_, j_;
  Components<dim> places_;
  std::vector<double> rest_, share_, tilts_;
  // Of all atoms.
  std::vector<double> atom_records_, density_;
  std::array<double, 8> pair_energy_ = {}; // J
};
} // namespace ligament::md
