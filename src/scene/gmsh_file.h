// Meshes from gmsh files: what is needed of them, by dimension of the elements.
#pragma once

#include "core/types.h"

#include <string>
#include <vector>

namespace ligament::program
{
struct GmshMesh
{
  struct Element
  {
    std::vector<int> corners; // into the nodes, in gmsh's order; a line has 2, a triangle 3, ...
    std::string name;         // of its physical group; empty: none
  };
  std::vector<Vector<3>> nodes;               // m
  std::vector<Element> lines, faces, volumes; // triangles and quadrilaterals are faces
  bool was_second_order = false;              // nodes on edges were left out
};

/// Reads a text file of version 2.2 or 4.1, lengths in m. Elements of second order keep their
/// corners. Throws core::KeyedError about the key, with the line, where it can't be read, is binary
/// or of another version, or where a name of a physical group has no elements.
GmshMesh read_gmsh(const std::string &file, const std::string &key);
} // namespace ligament::program
