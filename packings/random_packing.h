// Random packings: Voronoi or Laguerre cells of relaxed random seeds, cut by the specimen.
#pragma once

#include "core/ranks.h"
#include "packings/packing.h"
#include "packings/seeds.h"

namespace ligament::packings
{
template <int dim>
struct RandomParameters : SpecimenParameters<dim>
{
  int seed = 1;
  int relaxation_sweeps = 10;
  double size_ratio = 1; // largest over smallest radius, at most 5
};

template <int dim>
struct RandomPacking
{
  Packing<dim> packing;
  /// Of all cells and of the neighbours that are left out at coupled sides: from these
  /// pack_seeds makes the same packing again, to round-off.
  Seeds<dim> seeds;
  int n_healed = 0; // particles whose radius was made smaller, see heal_radii
};

/// Packs the zone of the specimen with cells of mean volume sqrt(3)/2 d^2 t (2D) or d^3/sqrt(2).
///
/// Seeds are drawn (see draw_seeds), then moved to the centroids of their cells `relaxation_sweeps`
/// times (Lloyd), while the radii grow to their size; then those nearer than 0.3 d (small ones: 0.3
/// of their size) to a surface are pushed away from it. A zone gets the cells that the whole
/// specimen has there: seeds around it are relaxed, too.
///
/// Throws core::InputError for impossible parameters, an empty zone, and material too thin for the
/// particles.
template <int dim>
RandomPacking<dim> make_random_packing(const RandomParameters<dim> &parameters);

/// Its seeds as they are after relaxation, with radii that are not healed yet: what takes most of
/// the time. Of several ranks, which all call it, each moves some of them and has all.
template <int dim>
Seeds<dim> make_random_seeds(const RandomParameters<dim> &parameters,
                             const core::Ranks &ranks = {});

/// The packing of seeds that make_random_seeds() found for the specimen; or of any that
/// pack_seeds() has taken.
template <int dim>
RandomPacking<dim> pack_relaxed_seeds(const SpecimenParameters<dim> &specimen, Seeds<dim> seeds);

/// The packing of given seeds, in the order of their ids: Laguerre cells, cut by the specimen's
/// true surface. All levers end at the centroid of the face, so that (D2a), (D2b) hold to round-off
/// for every cell with all its neighbours. No cell is lost: radii are healed first.
///
/// Sides of the zone strictly inside the specimen are coupled: particles whose cell reaches across
/// are left out, and the cells at the edge have neither Face nor BoundaryFace there. Cracks cut
/// faces as on lattices (make_lattice_packing). There are no directions and no rows.
///
/// Throws core::InputError when a seed lies outside the material or where another one is, and where
/// seeds are too sparse to fill the zone.
template <int dim>
RandomPacking<dim> pack_seeds(const SpecimenParameters<dim> &specimen, Seeds<dim> seeds);
} // namespace ligament::packings
