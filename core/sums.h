// Sums of terms that come by number, without an order.
#pragma once

#include "core/exact_sum.h"

namespace ligament::core
{
/// Of term(0) to term(n - 1).
template <typename Term>
ExactSum exact_sum(std::size_t n, Term &&term)
{
  ExactSum sum;
  for (std::size_t i = 0; i < n; ++i)
    sum.add(term(i));
  return sum;
}
} // namespace ligament::core
