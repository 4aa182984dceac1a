// The discrete half of a body from its scene: packing, materials, strengths, force.
#pragma once

#include "src/simulation/coupled_body.h"

namespace ligament::program
{
/// Fills in zone, force, seeds, stable step and figures; `loads` must be there. Throws
/// core::InputError where the scene can't be built.
template <int dim>
void make_zone(const Scene &scene, CoupledBody<dim> &body, core::Log &log);

/// The material that the particles share with the far field.
dem::DemMaterial material_of(const Scene &scene);

/// m^3, of the whole cells of the packing.
double mean_cell_volume(const Scene &scene);
} // namespace ligament::program
