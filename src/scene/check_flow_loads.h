// Tractions under which overlap and far field, which must stay elastic, would flow.
#pragma once

#include "src/scene/findings.h"
#include "src/scene/scene.h"

namespace ligament::program
{
/// Warns where the tractions of a scene stress a box uniformly beyond the first yield stress of
/// its base material, which the overlap is made of.
void check_flow_loads(const Scene &scene, Findings &findings);
} // namespace ligament::program
