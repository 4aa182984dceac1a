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

/// The outer faces of absorbing sides answer with density c v per area, component by component; in
/// their layers all particles are damped (theory.md eqs. (A1), (A4), (A7)). Spins are not. Density
/// in kg/m^3. Of a part those of the particles that it steps; all ranks call it.
template <int dim>
core::Dashpots<dim>
absorbing_dashpots(const Packing<dim> &packing, const particles::Particles<dim> &particles,
                   const std::vector<core::BoundaryLoad<dim>> &loads, double density,
                   const SideSpeeds<dim> &speeds, const core::Ranks &ranks = {});
} // namespace ligament::packings
