// Which of two faces is nearer to its limit: the same one in any order of looking.
#pragma once

#include "particles/force_report.h"

#include <algorithm>

namespace ligament::particles
{
/// The one that bears the larger share; of equal ones that with the smaller x, then y, then z.
template <int dim>
bool is_worse(const Utilisation<dim> &a, const Utilisation<dim> &b)
{
  if (a.share != b.share)
    return a.share > b.share;
  return std::lexicographical_compare(a.place.begin(), a.place.end(), b.place.begin(),
                                      b.place.end());
}
} // namespace ligament::particles
