// A packet of plane waves through the overlap at any angle and in both directions: what comes back,
// what goes on, and as which kind of wave.
#pragma once

#include "src/verification/bodies/waves_strip.h"
#include "src/verification/instruments/bloch.h"

namespace ligament::program
{
struct PassageParameters
{
  WaveKind kind = WaveKind::p;
  double wave_length;    // cells
  double angle = 0;      // degrees from the normal; the strip's width rounds it, see PassageFigures
  bool outwards = true;  // from the particles to the mesh; else back
  double lengths = 8;    // of the packet, in wave lengths: from e^-2 to e^-2 of the envelope
  StripParameters strip; // widths and lengths of it are chosen here
};

/// Shares of the packet's energy.
struct PassageFigures
{
  double angle = 0; // degrees, of the middle of the packet
  WaveEnergy reflected, transmitted;
  double lost = 0; // by dampers, and by schemes that don't keep energy

  /// What the sums above miss: waves that are still in the overlap, and errors of the method.
  double missing() const { return 1 - reflected.sum() - transmitted.sum() - lost; }
};

/// docs/verification_waves.md, "Wave bench".
template <int dim>
PassageFigures measure_passage(const PassageParameters &parameters);

/// Waves of the hexagonal (2D) or FCC (3D) packing of spacing 1, layers along the last axis.
template <int dim>
BlochWaves<dim> make_bloch_waves(const dem::DemMaterial &material);

/// A wave of this length in cells that repeats itself across a strip of whole cells, at most 2 %
/// off the tangential wave number that the angle (degrees) asks for; it travels upwards.
template <int dim>
struct StripWave
{
  int cells_across;
  Vector<dim> wave_vector; // rad/m
  double angle;            // degrees
};
template <int dim>
StripWave<dim> fit_wave(double wave_length, double angle, double cell_size);

/// Distance of the layers of the hexagonal and of the FCC packing of spacing 1.
template <int dim>
inline constexpr double layer_height = dim == 2 ? 0.86602540378443865 : 0.70710678118654752;

/// What measure_energy reads: particles up to `end`, nodes from `begin` on without the last layer.
template <int dim>
std::vector<Site<dim>> particle_sites(const particles::Particles<dim> &particles, double end);
template <int dim>
std::vector<Site<dim>> node_sites(const fem::FemSolver<dim> &far, double begin);

/// Particles follow the packet, spins included; amplitude in m.
template <int dim>
void set_packet(particles::Particles<dim> &state, const Packet<dim> &packet, double amplitude);
} // namespace ligament::program
