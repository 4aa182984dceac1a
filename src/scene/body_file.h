// Bodies from files: an outline or a surface, with the names of its sides.
#pragma once

#include "core/outline.h"
#include "src/scene/gmsh_file.h"

namespace ligament::program
{
struct BodyFile
{
  std::vector<std::string> names; // of sides
  /// 2D: outer ones counter-clockwise, holes clockwise; boundaries are numbers of names, -1: none.
  std::vector<core::Polygon> polygons;
  /// 3D, boundaries likewise.
  std::vector<Vector<3>> vertices;
  std::vector<core::Solid<3>::Facet> facets;
  GmshMesh mesh; // empty for STL
};

/// Reads gmsh's .msh, in 3D also .stl (text or binary), lengths in m. In 2D the elements must lie
/// in a plane across z; their outer edges are the outline. In 3D the outer faces of the volumes are
/// the surface, quadrilaterals split in two; without volumes the faces themselves. Throws
/// core::KeyedError about /specimen/file where that can't be read or bounds no body.
BodyFile read_body(const std::string &file, int dim);
} // namespace ligament::program
