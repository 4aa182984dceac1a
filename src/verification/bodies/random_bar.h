// A bar of random packing that repeats itself sideways.
#pragma once

#include "packings/packing.h"
#include "packings/seeds.h"

namespace ligament::program
{
/// Seeds of spacing 1 for the bar [0, width]^(dim-1) x [0, length], periodic sideways, with flat
/// ends: drawn at random, relaxed by ten of Lloyd's sweeps. Their ids count upwards along the bar.
/// `width` is at least 4.
template <int dim>
packings::Seeds<dim> make_periodic_seeds(double width, double length, int seed);

/// The same seeds up to `from` (along the bar), others behind, relaxed so that they join.
template <int dim>
packings::Seeds<dim> make_other_end(const packings::Seeds<dim> &seeds, double width, double length,
                                    double from, int seed);

/// Packing of this bar up to `zone_end`: beyond the bar's length all of it, with a free surface;
/// else an edge as that of a coupled side (packings::pack_seeds). Neighbours across the sides are
/// those of the other side; global ids are those of the seeds.
template <int dim>
packings::Packing<dim> pack_periodic(const packings::Seeds<dim> &seeds, double width, double length,
                                     double zone_end);
} // namespace ligament::program
