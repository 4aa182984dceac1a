// A body that moves when its run begins.
#pragma once

#include "src/simulation/coupled_body.h"

namespace ligament::program
{
/// The kinetic energy is booked as work done on the body before. Gives particles, nodes and overlap
/// the velocities of the scene, as those of half a step before the beginning. Members of the
/// overlap move and turn with the mesh: there is no fine-scale motion.
template <int dim>
void start_motion(const Scene &scene, CoupledBody<dim> &body);

/// Whether anything of the body turns at the beginning.
bool begins_with_spin(const Scene &scene);

/// Whether a particle or a node lies in the region; of the body, which all of several ranks ask.
template <int dim>
bool moves_any(const Region &region, const CoupledBody<dim> &body);
} // namespace ligament::program
