// Symmetric tensors in Voigt order, as stresses are summed up.
#pragma once

#include "core/types.h"

namespace ligament::dem
{
/// The tensor a (x) b, symmetric part, in Voigt order without engineering factors.
template <int dim>
Strain<dim> symmetric_product(const Vector<dim> &a, const Vector<dim> &b)
{
  Strain<dim> s;
  for (int c = 0; c < dim; ++c)
    s[c] = a[c] * b[c];
  if constexpr (dim == 2)
    s[2] = (a[0] * b[1] + a[1] * b[0]) / 2;
  else {
    s[3] = (a[1] * b[2] + a[2] * b[1]) / 2;
    s[4] = (a[0] * b[2] + a[2] * b[0]) / 2;
    s[5] = (a[0] * b[1] + a[1] * b[0]) / 2;
  }
  return s;
}
} // namespace ligament::dem
