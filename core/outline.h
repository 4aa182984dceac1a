// Closed plane curves of straight lines and arcs, and what bodies they bound.
#pragma once

#include "core/solid.h"

#include <optional>

namespace ligament::core
{
/// The way to a corner from the one before it: straight, or along an arc.
struct OutlineEdge
{
  Vector<2> to = Vector<2>::Zero(); // m
  std::optional<Vector<2>> centre;  // m, of an arc
  bool clockwise = false;           // an arc's way about its centre
  int boundary = inner_surface<2>;
};

/// Its first edge begins at the last one's end. A single edge with a centre is a whole circle.
using Outline = std::vector<OutlineEdge>;

Outline circle(const Vector<2> &centre, double radius, int boundary);
Outline rectangle(const Vector<2> &lower, const Vector<2> &upper,
                  const std::array<int, 4> &boundaries); // left, right, bottom, top

/// A corner of a polygon and the boundary that the side from here to the next one belongs to.
struct PolygonCorner
{
  Vector<2> place; // m
  int boundary;
};
using Polygon = std::vector<PolygonCorner>;

/// The outline with its arcs cut into straight sides no longer than `side` (m) or an eighth of a
/// circle. Arcs keep their ends; corners between them lie as far outside that the area of the
/// segment is the arc's. Throws core::InputError where an arc has no radius, another one at its
/// end, or so large a one that it has more than 2e5 sides.
Polygon polygon(const Outline &outline, double side);

double signed_area(const Polygon &polygon); // m^2, positive where it runs counter-clockwise

/// Where two sides of these polygons meet that are not neighbours, the first such place.
std::optional<Vector<2>> crossing(const std::vector<Polygon> &polygons);

/// The body between polygons: outer ones run counter-clockwise, holes clockwise.
Solid<2> make_solid(const std::vector<Polygon> &polygons);

/// The same as a prism from `lower` to `upper` (m) along z, whose ends belong to two boundaries.
Solid<3> extrude(const std::vector<Polygon> &polygons, double lower, double upper,
                 const std::array<int, 2> &ends);

/// A ball of flat sides no longer than about `side` (m), of the volume of the true one.
Solid<3> make_ball(const Vector<3> &centre, double radius, double side, int boundary);
} // namespace ligament::core
