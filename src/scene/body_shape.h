// The body that the keys of /specimen describe: its box, its outline as polygons, its solid.
#pragma once

#include "core/box_union.h"
#include "core/outline.h"
#include "core/part.h"
#include "src/scene/scene.h"

#include <memory>

namespace ligament::program
{
/// Names of the sides by number (core/types.h): those of the box, an empty one for what has no
/// name, then those that the scene gives.
std::vector<std::string> side_names_of(const Specimen &specimen, int dim);

/// Sets size and centre of the box around a body that follows from an outline, a ball or a file.
/// Throws core::KeyedError where that has no extent, or the file can't be read.
void enclose_body(Specimen &specimen, int dim);

/// The outline less cutouts and slots, with `voids` less holes and notches, too; arcs in straight
/// sides of up to `side` (m). Sides without a name that lie on the box have its number. Throws
/// core::KeyedError with key, reason and remedy where one of them crosses itself, has no area or
/// lies outside, and where nothing is left.
std::vector<core::Polygon> outline_of(const Specimen &specimen, int dim, double side, bool voids);

/// The body, in 2D less its holes and notches; null where it is plain (Specimen::is_plain).
template <int dim>
std::shared_ptr<const core::Solid<dim>> solid_of(const Specimen &specimen, double side);

/// The outline of the body as its mesh follows it, arcs in sides of up to `side` (m): holes and
/// notches left out of it where they do not lie in the boxes that the mesh leaves out anyway. Null
/// where it is a box. Throws core::KeyedError for bodies that have no outline.
template <int dim>
std::shared_ptr<const core::Solid<2>> mesh_outline_of(const Specimen &specimen, double side,
                                                      const core::BoxUnion<dim> &left_out);

/// The plane faces of the body's surface by side. Ends of a prism with openings are given without
/// these, a cut leads to each. The body is made once, which takes seconds for large surfaces.
template <int dim>
class SurfaceFaces
{
public:
  explicit SurfaceFaces(const Specimen &specimen);
  std::vector<core::FaceCorners<dim>> of(int boundary) const;

private:
  const Specimen &specimen_;
  std::shared_ptr<const core::Solid<dim>> solid_; // null: a box
};

/// Of one side.
template <int dim>
std::vector<core::FaceCorners<dim>> faces_of(const Specimen &specimen, int boundary)
{
  return boundary < 0 ? std::vector<core::FaceCorners<dim>>()
                      : SurfaceFaces<dim>(specimen).of(boundary);
}

/// Whether points lie in the body.
class BodyTest
{
public:
  BodyTest(const Specimen &specimen, int dim);
  /// Points on the surface belong to it, up to 1e-5 of the specimen.
  bool contains(const Point &x) const;

private:
  const Specimen &specimen_;
  const int dim_;
  double tolerance_; // m
  std::shared_ptr<const core::Solid<2>> flat_;
  std::shared_ptr<const core::Solid<3>> solid_;
};
} // namespace ligament::program
