// Dashpots of the particles at sides of the specimen that let waves out.
#pragma once

#include "core/dashpots.h"
#include "core/load.h"
#include "core/ranks.h"
#include "packings/packing.h"

namespace ligament::packings
{
/// The outer faces of absorbing sides answer with density c_P v_n, density c_S v_t per area; in
/// their layers all particles are damped (theory.md eqs. (A1), (A4), (A7)). Spins are not. Density
/// in kg/m^3, speeds in m/s. Of a part those of the particles that it steps; all ranks call it.
template <int dim>
core::Dashpots<dim>
absorbing_dashpots(const Packing<dim> &packing, const particles::Particles<dim> &particles,
                   const std::vector<core::BoundaryLoad<dim>> &loads, double density,
                   double wave_speed_p, double wave_speed_s, const core::Ranks &ranks = {});
} // namespace ligament::packings
