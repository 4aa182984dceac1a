// The far field's operator as deal.II's own MatrixFree evaluates it: what our cell kernel is
// measured against.
#pragma once

#include <functional>

namespace ligament::bench
{
/// A product with the stiffness of a box of n^dim equal linear cells of size 1; the call returns
/// after f = K u. `unknowns` is set to their number.
template <int dim>
std::function<void()> matrix_free_product(int n, double lambda, double shear, long &unknowns);
} // namespace ligament::bench
