// Forces of a part of the energy of atoms of one kind, by vectors of pairs: the fast way of
// PartialAtoms.
#pragma once

#include "md/pair_table.h"

#include <vector>

namespace ligament::md
{
/// What the passes read and write. Pairs are padded to a multiple of 8 by such as are out of range.
struct PartialArrays
{
  int n_pairs;
  const int *i, *j;
  const double *reference[3];  // m, from i to j or its image
  const double *share, *tilts; // of phi; of f at both ends, J
  /// Four numbers per atom: displacement in m (2D: two and a zero), and what its embedding adds to
  /// the tilts.
  const double *atoms;
  const PairPiece *table;
  double cutoff2, beyond2, inverse_step; // m^2, and a little more; 1/m
  double *pull, *slope;                  // of pairs, between the passes: phi'/r in N/m, f'/r
  double *density;                       // of atoms
  double *force;                         // of atoms, 4 numbers each, N; to be added to
  const double *rest;                    // distances at rest, m
  double end;                            // cut-off over the table's step
  double *energy;                        // 8 numbers, whose sum is that of pairs and tilts, J
};

struct PartialPasses
{
  using Pass = void (*)(const PartialArrays &);
  /// Densities and what lies between; forces of that. Without embedding: forces.
  Pass first, second, pairs;
  /// Energy less that at rest, and into `density` what that is more than at rest. Without
  /// embedding: energy.
  Pass changes, pair_changes;
};
/// Those of the instruction set at hand.
template <int dim>
PartialPasses partial_passes();
} // namespace ligament::md
