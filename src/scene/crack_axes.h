// Which way the cracks of a scene point: what a lattice holds depends on it.
#pragma once

#include "core/types.h"
#include "src/scene/scene.h"

namespace ligament::program
{
/// Unit vectors.
template <int dim>
struct CrackAxes
{
  Vector<dim> growth = Vector<dim>::Unit(0);
  Vector<dim> normal = Vector<dim>::Unit(1); // of its plane

  bool operator==(const CrackAxes &other) const
  {
    return growth == other.growth && normal == other.normal;
  }
};

/// Of the first crack, slot or notch of the specimen that ends in it: the way along which it grows
/// from there, and across which it opens. Along x and across y where nothing is cut. A lattice is
/// its own image by inversion, so that of the two senses of each the one is told whose first
/// component is positive.
template <int dim>
CrackAxes<dim> crack_axes(const Specimen &specimen);
} // namespace ligament::program
