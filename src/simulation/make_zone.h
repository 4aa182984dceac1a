// The discrete half of a body from its scene: packing, force, particles.
#pragma once

#include "src/simulation/coupled_body.h"
#include "src/simulation/tools/contact_surface.h"

namespace ligament::program
{
/// Fills in zone, seeds, cut faces, stable step and figures; `loads` must be there, and the far
/// field if there is one. Throws
/// core::InputError where the scene can't be built. Adds what tools feel of it to `surface`.
/// `weights`: see make_body().
template <int dim>
void make_zone(const Scene &scene, const ForceMaker<dim> &make_force, Reference &reference,
               const std::vector<std::int64_t> &weights, CoupledBody<dim> &body,
               ContactSurface<dim> &surface, core::Log &log);
} // namespace ligament::program
