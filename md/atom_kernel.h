// Forces of atoms of one kind by vectors of pairs: the fast way of AtomForce.
#pragma once

#include "md/neighbour_list.h"
#include "md/potential.h"

#include <cstdint>

namespace ligament::md
{
/// f and phi of one interval of distance, one cache line: f = c[0] + t (c[1] + t (c[2] + t c[3])).
struct alignas(64) PairPiece
{
  double density[4], pair[4];
};

/// Pairs in range of the slots of a block, between the passes.
struct PairBuffer
{
  std::vector<std::int32_t> place;   // record of the other atom
  std::vector<std::int32_t> other;   // its slot, where there are images
  std::vector<double> density, pair; // -f'/r and -phi'/r, per m^2 and N/m
  std::vector<int> row_end;          // per slot: where its pairs end
};

/// Slots that go through the passes together.
struct SlotBlock
{
  int first, last; // to before the last
};

/// What the passes read and write.
struct KernelArrays
{
  const AtomRecord *records;
  const int *begin, *neighbours;
  const int *slot_of_image; // null where there are none
  int n_atoms;
  const PairPiece *table;
  double cutoff2, inverse_step; // m^2, 1/m
  double *density, *slope;      // rho and F' of slots
  AtomRecord *force;            // of slots, N
  double *scratch;              // 5 numbers per pair of a block, and some vectors; aligned
};

/// The first pass: pairs of a block in range, their functions, and what they add to densities. The
/// second: their forces, where all F' are known.
using KernelPass = void (*)(const KernelArrays &, const SlotBlock &, PairBuffer &);
struct KernelPasses
{
  KernelPass first, second;
};
/// Those of the instruction set at hand.
KernelPasses kernel_passes();

/// For potentials of one species. Sums are in the order of the list: same list, same bits.
class AtomKernel
{
public:
  explicit AtomKernel(const Potential &potential);

  bool can_compute() const { return !table_.empty(); }

  /// Overwrites the forces of all atoms by those at the list's places.
  template <int dim>
  void compute(const NeighbourList &list, Components<dim> &force);

private:
  void prepare(const NeighbourList &list);
  void find_slopes(const SlotBlock &block);

  std::vector<PairPiece> table_;
  Spline embedding_;
  double cutoff_, inverse_step_ = 0;
  bool has_embedding_;

  int build_ = -1; // number of the list for which the blocks are
  std::vector<SlotBlock> blocks_;
  /// After a block's first pass: of which blocks the densities are whole, and which are due for the
  /// second.
  std::vector<std::vector<int>> whole_after_, due_after_;
  std::vector<int> slot_of_image_;
  std::vector<PairBuffer> buffers_; // more than blocks wait between the passes
  std::vector<int> buffer_of_, free_buffers_;
  std::vector<double> density_, slope_;
  std::vector<AtomRecord> force_, scratch_;
};
} // namespace ligament::md
