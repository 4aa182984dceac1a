// A picture of what a scene sets up: both models and where they join, cracks, loads and supports.
#pragma once

#include "src/drawing/picture.h"
#include "src/scene/scene.h"
#include "src/simulation/coupled_body.h"

namespace ligament::program
{
/// The body at rest: particles and cells coloured by their part in the coupling, arrows for motions
/// and tractions, hatched sides where they are held.
template <int dim>
Picture scene_picture(const CoupledBody<dim> &body, const Scene &scene);
} // namespace ligament::program
