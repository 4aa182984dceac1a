// The symmetric part of a displacement's gradient.
#pragma once

#include "core/types.h"

namespace ligament::program
{
/// Voigt order, shear strains in full (twice the tensor's).
template <int dim>
Strain<dim> small_strain(const Eigen::Matrix<double, dim, dim> &gradient)
{
  Strain<dim> e;
  for (int c = 0; c < dim; ++c)
    e[c] = gradient(c, c);
  if constexpr (dim == 2)
    e[2] = gradient(0, 1) + gradient(1, 0);
  else {
    e[3] = gradient(1, 2) + gradient(2, 1);
    e[4] = gradient(0, 2) + gradient(2, 0);
    e[5] = gradient(0, 1) + gradient(1, 0);
  }
  return e;
}
} // namespace ligament::program
