// What openings leave of an outline.
#pragma once

#include "core/outline.h"

#include <string>

namespace ligament::program
{
/// The first n polygons, of which those that run clockwise are holes, without the others, which may
/// overlap them and each other. Sides keep the boundaries that they had. What is shorter than the
/// tolerance (m) is nothing; it must be above 1e-8 of the figure, to which corners are found again.
/// Throws core::KeyedError with the key of a polygon that takes nothing away, and where nothing is
/// left.
std::vector<core::Polygon> cut_polygons(const std::vector<core::Polygon> &polygons, std::size_t n,
                                        const std::vector<std::string> &keys, double tolerance);
} // namespace ligament::program
