// How far apart two crack paths are: distances between their broken faces.
#pragma once

#include "src/output/fields.h"

#include <vector>

namespace ligament::program
{
/// Distance from the centroid of each face of `from` to the nearest centroid of `to`, in m. Empty
/// when `to` is empty.
std::vector<double> nearest_distances(const std::vector<BrokenBond> &from,
                                      const std::vector<BrokenBond> &to);
} // namespace ligament::program
