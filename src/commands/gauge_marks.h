// Gauges in the picture of a scene.
#pragma once

#include "src/drawing/picture.h"
#include "src/scene/scene.h"

namespace ligament::program
{
/// Lines between the points of gauges, crosses at single ones, the outlines of boxes, cut to the
/// specimen; forces and fragments have no place.
void add_gauges(const Scene &scene, Picture &picture);
} // namespace ligament::program
