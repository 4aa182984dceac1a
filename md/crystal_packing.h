// Crystals cut to shape: where atoms lie at first.
#pragma once

#include "md/crystal.h"
#include "packings/packing.h"

#include <functional>

namespace ligament::md
{
template <int dim>
struct CrystalShape
{
  /// m; atoms on the lower sides are in, those on the upper ones are not (to 1e-6 spacings), so
  /// that boxes of whole periods tile.
  Vector<dim> lower = Vector<dim>::Zero(), upper = Vector<dim>::Zero();
  Vector<dim> anchor = Vector<dim>::Zero();           // m: an atom of the lattice lies here
  std::function<bool(const Vector<dim> &)> keep = {}; // m; where atoms stay; empty: everywhere
  std::array<bool, dim> periodic = {};                // axes along which the box repeats itself
  /// m; the specimen that the box is a part of: sides of the box that are its sides may be loaded.
  Vector<dim> specimen_lower = Vector<dim>::Constant(-1e300),
              specimen_upper = Vector<dim>::Constant(1e300);
};

/// Atoms in the order of their rows along the first primitive vector (`row_begin`: runs without a
/// gap), rows in the order of a space-filling curve; names, order and positions depend on lattice
/// and anchor alone. Every atom has the volume of the crystal; there are no faces between atoms.
/// The atoms within one range of a side of the specimen share its area evenly as boundary faces.
/// Throws core::InputError for an empty crystal, one of more than 2^31 atoms and sides that are not
/// a period of it.
template <int dim>
packings::Packing<dim> cut_crystal(const Crystal<dim> &crystal, const CrystalShape<dim> &shape);

/// At rest, with the masses of their species (of each atom; empty: the crystal's), without
/// orientations.
template <int dim>
particles::Particles<dim> make_atoms(const Crystal<dim> &crystal,
                                     const packings::Packing<dim> &packing,
                                     const std::vector<int> &species = {});
} // namespace ligament::md
