// How large the models of a scene will be, from volumes: an answer before anything is built.
#pragma once

#include "src/scene/scene.h"

namespace ligament::program
{
struct SizeEstimate
{
  double particles = 0;            // of the discrete zone
  double overlap_particles = 0;    // of them
  double equivalent_particles = 0; // of the pure discrete model
  double cells = 0;                // of the far field, overlap included
};

/// By 2e5 points spread evenly over the specimen, right to about a per cent; `cell_volume` in m^3
/// is the mean one of a particle. Cells are counted at the sizes that their distance from the zone
/// asks for: a tenth or two too few where few of them are of a size.
SizeEstimate estimate_size(const Scene &scene, double cell_volume);
} // namespace ligament::program
