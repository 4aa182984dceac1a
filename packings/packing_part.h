// The part of a packing that one rank holds: its own particles and those around that its forces
// read; and what lies in an overlap.
#pragma once

#include "packings/packing.h"
#include "particles/partition.h"

#include <functional>

namespace ligament::packings
{
/// Particles that are stepped together: whoever owns one of a group steps all of it.
template <int dim>
struct Groups
{
  /// The group at a place (m), below 0: none. Empty: there are no groups.
  std::function<int(const Vector<dim> &)> of;
  double reach = 0; // m, largest distance along an axis between two of one group
};

template <int dim>
struct PackingPart
{
  /// What is held, in the order of the whole, with the faces between what is held. Cells of the
  /// outermost ring lack faces.
  Packing<dim> packing;
  /// Owned, which are stepped with all that share a group with them, and what lies within so many
  /// faces of what is stepped.
  particles::Part part;
  std::vector<int> owner;   // of each that is held
  std::vector<int> place;   // of each that is held, in the whole
  std::int64_t n_whole = 0; // particles
};

/// `rings` of ghosts lie around what rank `rank` steps: all are turned, those within one ring less
/// are pressed. Particles beside each other across a crack are neighbours, too. Made from the whole
/// packing, or from a piece of it that holds at least the part and begins with the `first` particle
/// of the whole. Either is used up: it never lies in memory beside its part.
template <int dim>
PackingPart<dim> part_of(Packing<dim> whole, const particles::Partition &partition, int rank,
                         int rings, std::int64_t first = 0, const Groups<dim> &groups = {});

/// The same from any particles of the whole that hold at least the part, given their places there,
/// ascending. Sizes of the whole are those in Packing::whole, or of lattice directions.
template <int dim>
PackingPart<dim> part_of(Packing<dim> piece, const std::vector<int> &places,
                         const particles::Partition &partition, int rank, int rings,
                         const Groups<dim> &groups = {});

/// The particles that are in a group and `rings` of neighbours around them, in the order of the
/// whole, with the faces between them as part_of() has them.
template <int dim>
Packing<dim> grouped_part(Packing<dim> whole, const Groups<dim> &groups, int rings);

/// Which particles these are, ascending.
template <int dim>
std::vector<int> grouped_places(const Packing<dim> &whole, const Groups<dim> &groups, int rings);

/// The particles at these places, ascending, and the faces between them; sizes are those of the
/// whole.
template <int dim>
Packing<dim> those_at(const std::vector<int> &places, Packing<dim> whole);
} // namespace ligament::packings
