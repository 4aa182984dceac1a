// Surfaces of triangles from STL files.
#pragma once

#include "core/solid.h"

#include <string>

namespace ligament::program
{
/// Reads a text or binary file, lengths in m; corners nearer than 1e-7 of its extent are one. Adds
/// its triangles with boundary -1. Throws core::KeyedError about the key where it can't be read.
void read_surface(const std::string &file, const std::string &key, std::vector<Vector<3>> &vertices,
                  std::vector<core::Solid<3>::Facet> &facets);
} // namespace ligament::program
