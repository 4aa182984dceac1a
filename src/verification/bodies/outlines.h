// Unit bodies of any outline: discs, rings, plates with a hole, and what is imposed on them.
#pragma once

#include "src/verification/bodies/unit_bodies.h"

namespace ligament::program
{
/// A closed circle about the centre; its side is named.
std::vector<OutlineCorner> circle(const Point &centre, double radius, const std::string &side);

/// A discrete body in the plane with this outline and these openings, d = 1.
Scene outlined_scene(const std::vector<OutlineCorner> &outline,
                     const std::vector<std::vector<OutlineCorner>> &openings,
                     double poissons_ratio);

/// Coupled: zone between these corners, cells of size 3.1 and transition of two cells.
void couple(Scene &scene, const Point &lower, const Point &upper);
} // namespace ligament::program
