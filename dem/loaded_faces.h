// Outer faces of cells on which something acts: walls and tractions.
#pragma once

#include "core/types.h"

#include <array>

namespace ligament::dem
{
/// Side of the specimen whose motion is prescribed: a bond of length q between the particle and the
/// wall. Du = P (u_wall - u_i - (a - A)) at the face centroid, P the prescribed components; stress
/// 2G Du/q + lambda theta P n; theta gets S n . Du / V. A motion that the wall allows and that is
/// affine is answered exactly, also by clipped cells.
template <int dim>
struct WallFace
{
  int i;
  Vector<dim> normal, lever;
  double area, q;
  Vector<dim> prescribed;    // 1 where the component is prescribed, 0 where it is free
  std::array<int, dim> load; // number of the load that prescribes the component, or -1
  double shear_modulus;      // Pa, of the particle
};

/// Outer face under a given traction (theory.md, loaded outer faces).
template <int dim>
struct TractionFace
{
  int i;
  Vector<dim> lever;
  double area;
  int load;
  Vector<dim> acting;   // 1 where the traction acts, 0 where a wall holds the component
  double shear_modulus; // Pa, of the particle
};
} // namespace ligament::dem
