// Boxes, and what of a cut lies inside one.
#pragma once

#include "core/box_union.h"
#include "core/part.h"
#include "src/scene/scene.h"

namespace ligament::program
{
struct Box
{
  Point lower, upper; // m
};

/// The discrete zone as a union of boxes: infinite where they reach the specimen's side or beyond.
template <int dim>
core::BoxUnion<dim> zone_shape(const Scene &scene)
{
  auto boxes = scene.zone.boxes;
  if (boxes.empty())
    boxes.push_back({scene.zone.lower, scene.zone.upper});
  core::BoxUnion<dim> shape;
  for (const ZoneBox &box : boxes) {
    auto &part = shape.boxes.emplace_back();
    for (int c = 0; c < dim; ++c) {
      const Specimen &s = scene.specimen;
      const double tolerance = 1e-9 * s.size[c];
      const bool outside = c >= scene.dimension;
      part.lower[c] = outside || box.lower[c] <= s.lower(c) + tolerance ? -infinity : box.lower[c];
      part.upper[c] = outside || box.upper[c] >= s.upper(c) - tolerance ? infinity : box.upper[c];
    }
  }
  return shape;
}

/// Whether the point, or an image of it beyond joined sides, lies in one of the balls (discs in 2D)
/// or boxes.
template <int dim>
bool is_in_regions(const Specimen &specimen, const std::vector<Hole> &balls,
                   const std::vector<Notch> &boxes, const Vector<dim> &x);

/// The direction across the side of the box that is loaded; -1: the side has a name of its own, or
/// the load is a jump.
inline int axis_across(const LoadParameters &load, int dim)
{
  return load.boundary >= 0 && load.boundary < 2 * dim ? load.boundary / 2 : -1;
}

/// What of its side the load acts on.
template <int dim>
core::Part<dim> part_of(const LoadParameters &load)
{
  const auto vector = [](const Point &p) { return Vector<dim>(p.data()); };
  if (load.within.is_ball()) {
    Vector<dim> centre;
    for (int c = 0; c < dim; ++c)
      centre[c] = load.within.centre[c].value_or(0);
    return core::Part<dim>::ball(centre, load.within.radius);
  }
  Vector<dim> lower = vector(load.within.lower), upper = vector(load.within.upper);
  const int along = axis_across(load, dim) == 0 ? 1 : 0;
  lower[along] = load.from.value_or(lower[along]);
  upper[along] = load.to.value_or(upper[along]);
  const bool is_whole = (lower.array() == -infinity).all() && (upper.array() == infinity).all();
  return is_whole ? core::Part<dim>() : core::Part<dim>::box(lower, upper);
}

/// Cells of size h between the inner end of the overlap and the first larger ones: what the scene
/// asks for, else so many that size steps keep off the transition.
int fine_cells(const Scene &scene);

/// Corners of the part of a segment or convex plane polygon inside the box, in the first dim
/// directions; empty when there is none.
std::vector<Point> clip(const std::vector<Point> &corners, const Box &box, int dim);

/// Whether the way from a to b crosses the crack or touches it.
bool crosses(const Crack &crack, const Point &a, const Point &b, int dim);

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
