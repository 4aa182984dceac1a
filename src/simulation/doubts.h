// What is possible of a body and hardly meant, and is seen only once it is made.
#pragma once

#include "core/log.h"
#include "src/scene/scene.h"
#include "src/simulation/coupled_body.h"

namespace ligament::program
{
/// Warns of cracks that cut no face, a body in pieces, motions that move nothing, layers that should
/// flow and cannot, and an end that a run cannot come to. The body is as it was made; all of several
/// ranks call it.
template <int dim>
void doubt_body(const Scene &scene, const CoupledBody<dim> &body, core::Log &log);
} // namespace ligament::program
