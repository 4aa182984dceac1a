// Random packings that repeat themselves in all directions but one.
#pragma once

#include "packings/packing.h"
#include "packings/seeds.h"

namespace ligament::packings
{
/// Seeds of spacing 1 for the bar [0, width]^(dim-1) x [0, length], periodic sideways, with flat
/// ends: drawn at random, relaxed by ten of Lloyd's sweeps. Their ids count upwards along the bar.
/// `width` is at least 4.
template <int dim>
Seeds<dim> make_periodic_seeds(double width, double length, int seed);

/// The same seeds up to `from` (along the bar), others behind, relaxed so that they join.
template <int dim>
Seeds<dim> make_other_end(const Seeds<dim> &seeds, double width, double length, double from,
                          int seed);

/// Packing of this bar up to `zone_end`: beyond the bar's length all of it, with a free surface;
/// else an edge as that of a coupled side (pack_seeds). Neighbours across the sides are
/// those of the other side; global ids are those of the seeds.
template <int dim>
Packing<dim> pack_periodic(const Seeds<dim> &seeds, double width, double length, double zone_end);
} // namespace ligament::packings
