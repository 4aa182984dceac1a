// Dashpots of the particles at sides of the specimen that let waves out.
#pragma once

#include "core/dashpots.h"
#include "core/load.h"
#include "core/ranks.h"
#include "packings/packing.h"

#include <vector>

namespace ligament::packings
{
/// For each axis across a side the speeds in m/s at which motions along x, y, z leave through it.
template <int dim>
struct SideSpeeds
{
  Vector<dim> across[dim];
};

template <int dim>
SideSpeeds<dim> isotropic_speeds(double wave_speed_p, double wave_speed_s)
{
  SideSpeeds<dim> speeds;
  for (int axis = 0; axis < dim; ++axis) {
    speeds.across[axis].setConstant(wave_speed_s);
    speeds.across[axis][axis] = wave_speed_p;
  }
  return speeds;
}

/// What a wave that leaves the body has run through.
template <int dim>
struct SideMedium
{
  double density; // kg/m^3
  SideSpeeds<dim> speeds;
};

/// The outer faces of absorbing sides answer with density c v per area, component by component; in
/// their layers all particles are damped (theory.md eqs. (A1), (A4), (A7)). Spins are not. A medium
/// for each of the packing's materials, or one for all particles. Of a part those of the particles
/// that it steps; all ranks call it.
template <int dim>
core::Dashpots<dim>
absorbing_dashpots(const Packing<dim> &packing, const particles::Particles<dim> &particles,
                   const std::vector<core::BoundaryLoad<dim>> &loads,
                   const std::vector<SideMedium<dim>> &media, const core::Ranks &ranks = {});
} // namespace ligament::packings
