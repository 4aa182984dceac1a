// What holds the small bodies that cracks run through: grips that draw apart, smooth walls.
#pragma once

#include "core/load.h"

#include <vector>

namespace ligament::dem
{
/// Grips at both ends of y that draw apart at this rate in m/s and leave x free; 3D: and z.
template <int dim>
std::vector<core::BoundaryLoad<dim>> grips(double opening_rate, double ramp = 0)
{
  std::vector<core::BoundaryLoad<dim>> loads(2);
  for (int k = 0; k < 2; ++k) {
    loads[k].boundary = 2 + k;
    loads[k].value[1] = (k == 0 ? -0.5 : 0.5) * opening_rate;
    loads[k].history = core::Ramp{ramp};
  }
  return loads;
}

/// Smooth walls at both ends of z: a slab between them is in plane strain. None in 2D.
template <int dim>
void add_smooth_walls(std::vector<core::BoundaryLoad<dim>> &loads)
{
  if constexpr (dim == 3)
    for (const int boundary : {4, 5}) {
      core::BoundaryLoad<3> wall;
      wall.boundary = boundary;
      wall.kind = core::BoundaryLoad<3>::Kind::displacement;
      wall.value[2] = 0;
      loads.push_back(wall);
    }
}
} // namespace ligament::dem
