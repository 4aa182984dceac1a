// Places of which no two are closer than a distance.
#pragma once

#include "core/types.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ligament::dem
{
template <int dim>
class PlacesApart
{
public:
  explicit PlacesApart(double distance) : distance_(distance) {}

  /// False, and the place is left out, when another one is too close.
  bool add(const Vector<dim> &place)
  {
    const auto close = [&](const Vector<dim> &other) {
      return (place - other).squaredNorm() < distance_ * distance_;
    };
    Cell cell;
    for (int k = 0; k < int(std::pow(3, dim)); ++k) {
      for (int c = 0, rest = k; c < dim; ++c, rest /= 3)
        cell[c] = std::lround(std::floor(place[c] / distance_)) + rest % 3 - 1;
      const auto found = cells_.find(cell);
      if (found != cells_.end() && std::any_of(found->second.begin(), found->second.end(), close))
        return false;
    }
    for (int c = 0; c < dim; ++c)
      cell[c] = std::lround(std::floor(place[c] / distance_));
    cells_[cell].push_back(place);
    return true;
  }

private:
  using Cell = std::array<long, dim>; // of the size `distance`
  double distance_;
  std::map<Cell, std::vector<Vector<dim>>> cells_;
};
} // namespace ligament::dem
