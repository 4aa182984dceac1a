// Lloyd's relaxation of seeds: each moves to the centroid of its cell.
#pragma once

#include "core/ranks.h"
#include "packings/periodic_sides.h"

namespace ligament::packings
{
/// Cells of seeds are cut from a cube of this half width, in units of the spacing.
inline constexpr double start_half_width = 6;

/// Seeds for a zone [lower, upper] of the specimen, drawn and relaxed so that in the zone and one
/// cell around it they are those of the whole specimen; none is nearer than 0.3 d (small ones: 0.3
/// of their size) to a surface, as far as corners allow. Those that corners leave nearer than 0.25
/// of it are removed. Of several ranks, which all call it, each moves its share of the seeds; all
/// have all of them, the same bits on any number.
template <int dim>
Seeds<dim> relaxed_seeds(const SpecimenShape<dim> &shape, double spacing, int seed,
                         double size_ratio, int sweeps, const Vector<dim> &lower,
                         const Vector<dim> &upper, const core::Ranks &ranks = {});

/// The same for a specimen that repeats itself: seeds of the box, relaxed among their images.
template <int dim>
Seeds<dim> relaxed_periodic_seeds(const SpecimenParameters<dim> &specimen,
                                  const PeriodicBox<dim> &box, int seed, double size_ratio,
                                  int sweeps);
} // namespace ligament::packings
