// What the overlap does to a wave that leaves the discrete zone: reflected and lost energy.
#pragma once

#include "src/verification/bodies/waves_strip.h"
#include "src/verification/instruments/wave_modes.h"

namespace ligament::program
{
struct WaveParameters
{
  WaveKind kind = WaveKind::p;
  double wave_length; // cells
  double fine_damper = 4, gap_filter = 0;
  int overlap_cells = 3, transition_cells = 6;
  int fine_layers = 0; // of cells before they double or grow, see StripParameters
  double growth = 1;
  double mesh_shift = 0.5; // layers of the packing, see StripParameters
  coupling::Scheme scheme = coupling::Scheme::fine_scale_split;
  // Energy-weighted schemes only:
  coupling::WeightShape weight = coupling::WeightShape::cubic;
  int multiplier_cells = 1;
  double step_fraction = 0.9;
};

/// Shares of the packet's energy.
struct WaveFigures
{
  double reflected; // came back into the discrete zone, kinetic energy after over before
  double lost;      // taken by the dampers of the overlap
  double missing; // of all mechanical energy, neither left nor booked: what the scheme itself lost
  double cost;    // seconds of the coupler per overlap particle and step
  double courant; // c_P dt over the length on which the weight goes from 0 to 1
};

/// Sends a packet from the zone at normal incidence into the mesh (docs/verification_waves.md).
template <int dim>
WaveFigures measure_wave(const WaveParameters &parameters);
} // namespace ligament::program
