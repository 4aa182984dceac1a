// The discrete half of a body from its scene: packing, force, particles.
#pragma once

#include "src/simulation/coupled_body.h"

namespace ligament::program
{
/// Fills in zone, seeds, cut faces, stable step and figures; `loads` must be there. Throws
/// core::InputError where the scene can't be built.
template <int dim>
void make_zone(const Scene &scene, const ForceMaker<dim> &make_force, Reference &reference,
               CoupledBody<dim> &body, core::Log &log);
} // namespace ligament::program
