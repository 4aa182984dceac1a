// Boxes, and what of a cut lies inside one.
#pragma once

#include "src/scene/scene.h"

namespace ligament::program
{
struct Box
{
  Point lower, upper; // m
};

/// Corners of the part of a segment or convex plane polygon inside the box, in the first dim
/// directions; empty when there is none.
std::vector<Point> clip(const std::vector<Point> &corners, const Box &box, int dim);

/// Smallest box around the points; at least one is needed.
Box bounding_box(const std::vector<Point> &points);

/// Largest distance between two of the points, in m.
double diameter(const std::vector<Point> &points);

/// Area of a plane polygon, in m^2.
double polygon_area(const std::vector<Point> &corners);

/// Whether the corners of a polygon lie in one plane (to 1e-6 of its diameter) and turn one way.
bool is_plane(const std::vector<Point> &corners);
bool is_convex(const std::vector<Point> &corners);
} // namespace ligament::program
