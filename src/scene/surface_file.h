// Closed surfaces of triangles from files.
#pragma once

#include "core/solid.h"

#include <string>

namespace ligament::program
{
/// Reads an STL file, text or binary, lengths in m; corners nearer than 1e-7 of its extent are one.
/// Its sides carry inner_surface<3>. Throws core::KeyedError (key /specimen/surface_file) where it
/// can't be read, leaves a gap, or is inside out.
core::Solid<3> read_surface(const std::string &file);
} // namespace ligament::program
