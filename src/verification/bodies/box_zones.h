// Unit bodies whose discrete zone is several boxes: with a re-entrant corner, and in two pieces.
#pragma once

#include "src/verification/bodies/unit_bodies.h"

namespace ligament::program
{
/// Boxes in place of the region of a scene that has a far field.
void set_boxes(Scene &scene, const std::vector<ZoneBox> &boxes);

/// Zone of two boxes with one re-entrant corner, h/d = 3.1, three cells of overlap.
Scene l_shape_2d(double poissons_ratio);

/// Two zones so near each other that their transitions meet, h/d = 3.1, three cells of overlap.
Scene two_zones_2d(double poissons_ratio);
} // namespace ligament::program
