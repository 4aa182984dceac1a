#include "fem/cell_classes.h"

#include <cmath>

namespace ligament::fem
{
template <int dim>
int CellClasses<dim>::number(const CellVectors<dim> &corners)
{
  const Vector<dim> origin = corners.col(0);
  const CellVectors<dim> shape = corners.colwise() - origin;
  const double extent = shape.cwiseAbs().maxCoeff();
  const int exponent = std::ilogb(extent);
  Key key;
  for (int i = 0; i < int(shape.size()); ++i)
    key[i] = std::llround(std::ldexp(shape.data()[i], 20 - exponent));
  key.back() = exponent;
  std::vector<int> &candidates = near_[key];
  for (const int k : candidates)
    if ((shape - shapes_[k]).cwiseAbs().maxCoeff() <= 1e-12 * extent)
      return k;
  candidates.push_back(size());
  shapes_.push_back(shape);
  return size() - 1;
}

template class CellClasses<2>;
template class CellClasses<3>;
} // namespace ligament::fem
