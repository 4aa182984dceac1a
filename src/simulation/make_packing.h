// The packing of the discrete zone from its scene.
#pragma once

#include "core/log.h"
#include "packings/lattice_packing.h"
#include "packings/random_packing.h"
#include "src/scene/scene.h"
#include "src/simulation/reference.h"

#include <optional>

namespace ligament::program
{
template <int dim>
struct PackedZone
{
  packings::Packing<dim> packing;
  std::optional<packings::Seeds<dim>> seeds; // of an irregular packing
  std::optional<int> n_healed;               // likewise: radii made smaller
};

/// With the materials of its particles, and the cracks cut. Throws core::InputError where the scene
/// can't be built.
template <int dim>
PackedZone<dim> make_packing(const Scene &scene, Reference &reference, core::Log &log);

template <int dim>
struct PartOfZone
{
  packings::PackingPart<dim> held;
  std::optional<packings::Seeds<dim>> seeds; // of the whole
  std::optional<int> n_healed;
  /// The particles in groups, whoever owns them, and rings around them, of an irregular packing.
  /// Lattices are packed there once more when it is needed (packings::make_grouped_lattice).
  std::optional<packings::Packing<dim>> overlap;
};

/// How far from the zone's inner sides particles belong to an overlap or neighbour those that do,
/// in m; 0: there is none.
double reach_of_overlap(const Scene &scene);

/// The part of it that a rank of several has, with so many rings of ghosts around what it steps.
/// Shares go by the weights of blocks (particles::make_partition). Lattices and random packings are
/// made by part; of a file each rank packs the whole and keeps its part.
template <int dim>
PartOfZone<dim> make_packing_part(const Scene &scene, Reference &reference,
                                  const core::Ranks &ranks, int rings, core::Log &log,
                                  const packings::Groups<dim> &groups = {},
                                  const std::vector<std::int64_t> &weights = {});

/// The specimen and the zone as packings see them.
template <int dim>
packings::SpecimenParameters<dim> packed_specimen_of(const Scene &scene);

/// What a packing of the scene's kind is made from.
template <int dim>
packings::LatticeParameters<dim> lattice_of(const Scene &scene);
template <int dim>
packings::RandomParameters<dim> random_packing_of(const Scene &scene);

/// m^3, of the whole cells of the packing.
double mean_cell_volume(const Scene &scene);

/// The first `dim` components.
template <int dim>
Vector<dim> to_vector(const Point &p)
{
  Vector<dim> v;
  for (int c = 0; c < dim; ++c)
    v[c] = p[c];
  return v;
}
} // namespace ligament::program
