// Forces of atoms of one kind by vectors of pairs: the fast way of AtomForce.
#pragma once

#include "md/neighbour_list.h"
#include "md/pair_table.h"
#include "md/pass_schedule.h"

#include <cstdint>

namespace ligament::md
{
/// Pairs in range of the slots of a block, between the passes.
struct PairBuffer
{
  std::vector<std::int32_t> place; // record of the other atom
  std::vector<std::int32_t> other; // its slot, where there are images
  std::vector<double> pull;        // -phi'/r, N/m
  std::vector<double> slope;       // (df/dt)/r of the density at the slot, per m
  std::vector<double> other_slope; // at the other; not where all are of one species
  std::vector<int> row_end;        // per slot: where its pairs end
  double energy = 0;               // J, of the pairs, where it is asked for
};

/// Slots that go through the passes together.
struct SlotBlock
{
  int first, last; // to before the last
};

/// What the passes read and write.
struct KernelArrays
{
  const AtomRecord *records; // extra: -F' over the step of the distance, when it is known
  const int *begin, *neighbours;
  const int *slot_of_image; // null where there are none
  int n_atoms;
  const PairPiece *table;       // of the species (a, b) from a * row + b * column on
  const int *row, *column;      // of slots; null where all are of one species
  double cutoff2, inverse_step; // m^2, 1/m
  double *density;              // of slots
  AtomRecord *force;            // of slots, N
  double *scratch;              // 5 numbers per pair of a block, and some vectors; aligned
};

/// The first pass: pairs of a block in range, their functions, and what they add to densities. The
/// second: their forces, where all F' are known. `energies` is the first one and finds the energy
/// of the pairs, too.
using KernelPass = void (*)(const KernelArrays &, const SlotBlock &, PairBuffer &);
struct KernelPasses
{
  KernelPass first, second, energies;
};
/// Those of the instruction set at hand.
KernelPasses kernel_passes();

/// Sums are in the order of the list: same list, same bits.
class AtomKernel
{
public:
  /// `species`: of each atom.
  AtomKernel(const Potential &potential, const std::vector<int> &species);

  /// Overwrites the forces of all atoms by those at the list's places.
  template <int dim>
  void compute(NeighbourList &list, Components<dim> &force);
  /// Of pairs and embeddings at the list's places, J.
  double energy(const NeighbourList &list);

private:
  void prepare(const NeighbourList &list);
  KernelArrays arrays(const NeighbourList &list);
  const Spline &embedding_of(const NeighbourList &list, int slot) const
  {
    return embedding_[species_.empty() ? 0 : species_[list.order()[slot]]];
  }
  PairBuffer &buffer(int number);

  std::vector<PairPiece> table_;
  std::vector<int> species_; // of each atom; empty: all are of the first of those that there are
  std::vector<Spline> embedding_;
  double cutoff_, inverse_step_;
  int n_species_ = 1;

  int build_ = -1; // number of the list for which the blocks are
  std::vector<SlotBlock> blocks_;
  PassSchedule schedule_;
  std::vector<int> slot_of_image_;
  std::vector<int> images_, image_begin_; // by the blocks of their slots
  std::vector<int> row_, column_;         // in the table, of slots
  std::vector<PairBuffer> buffers_;
  std::vector<double> density_;
  std::vector<AtomRecord> force_, scratch_;
};
} // namespace ligament::md
