// The part of a packing that one rank holds: its own particles and those around that its forces
// read.
#pragma once

#include "packings/packing.h"
#include "particles/partition.h"

namespace ligament::packings
{
template <int dim>
struct PackingPart
{
  /// What is held, in the order of the whole, with the faces between what is held. Cells of the
  /// outermost ring lack faces.
  Packing<dim> packing;
  /// Owned, which are stepped, and what lies within so many faces of them.
  particles::Part part;
  std::vector<int> owner;   // of each that is held
  std::vector<int> place;   // of each that is held, in the whole
  std::int64_t n_whole = 0; // particles
};

/// `rings` of ghosts lie around what rank `rank` owns: all are turned, those within one ring less
/// are pressed. Particles beside each other across a crack are neighbours, too. Made from the whole
/// packing, or from a piece of it that holds at least the part and begins with the `first` particle
/// of the whole.
template <int dim>
PackingPart<dim> part_of(const Packing<dim> &whole, const particles::Partition &partition, int rank,
                         int rings, std::int64_t first = 0);
} // namespace ligament::packings
