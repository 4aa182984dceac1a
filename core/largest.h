// The largest of many numbers, and where it is.
#pragma once

#include "core/types.h"

namespace ligament
{
/// Of numbers that are not negative. Of places with the same number it is the first by coordinates,
/// so that whichever order they come in, and however many ranks look, the same one is said.
template <int dim>
struct Largest
{
  double value = 0;
  std::array<double, dim> place = {}; // m, in the reference

  void take(double other, const Vector<dim> &at)
  {
    std::array<double, dim> there;
    for (int c = 0; c < dim; ++c)
      there[c] = at[c];
    take({other, there});
  }
  void take(const Largest &other)
  {
    if (other.value > value || (other.value == value && value > 0 && other.place < place))
      *this = other;
  }
};

/// The larger one; the first by coordinates where both are equal.
template <int dim>
Largest<dim> larger(Largest<dim> a, const Largest<dim> &b)
{
  a.take(b);
  return a;
}
} // namespace ligament
