// Waves through the overlap of any packing: what a coupled bar sends back that a bar of particles
// alone does not.
#pragma once

#include "src/verification/bodies/waves_strip.h"
#include "src/verification/cases.h"

namespace ligament::program
{
struct TwinParameters
{
  double wave_length;    // cells
  bool random = true;    // else the hexagonal or FCC lattice
  int seed = 1;          // of the random packing
  bool disorder = false; // also measure TwinFigures::disorder
  StripParameters strip; // its lengths are chosen here
};

/// Shares of the energy that is sent.
struct TwinFigures
{
  double reflected; // energy of the difference between the coupled bar and its twin
  double disorder;  // of two twins whose random packings differ behind the zone
  double lost;      // taken by the dampers of the overlap
};

/// P and S waves at normal incidence (docs/verification_waves.md, "Random packings").
template <int dim>
std::array<TwinFigures, 2> measure_twins(const TwinParameters &parameters);

std::vector<Case> waves_twin_cases();
} // namespace ligament::program
