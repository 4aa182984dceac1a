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
  /// The body repeats itself after `period` (m) along the axes where that is above 0.
  explicit PlacesApart(double distance, const Vector<dim> &period = Vector<dim>::Zero())
      : distance_(distance), period_(period)
  {
  }

  /// False, and the place is left out, when another one is too close, or an image of one.
  bool add(const Vector<dim> &place)
  {
    constexpr int n_images = dim == 2 ? 9 : 27;
    for (int k = 0; k < n_images && period_.maxCoeff() > 0; ++k) {
      Vector<dim> image = place;
      bool exists = true;
      for (int a = 0, rest = k; a < dim; ++a, rest /= 3) {
        image[a] += (rest % 3 - 1) * period_[a];
        exists = exists && (rest % 3 == 1 || period_[a] > 0);
      }
      if (exists && is_near_one(image))
        return false;
    }
    if (is_near_one(place))
      return false;
    cells_[cell_of(place)].push_back(place);
    return true;
  }

private:
  using Cell = std::array<long, dim>; // of the size `distance`

  Cell cell_of(const Vector<dim> &place) const
  {
    Cell cell;
    for (int c = 0; c < dim; ++c)
      cell[c] = std::lround(std::floor(place[c] / distance_));
    return cell;
  }
  bool is_near_one(const Vector<dim> &place) const
  {
    const auto close = [&](const Vector<dim> &other) {
      return (place - other).squaredNorm() < distance_ * distance_;
    };
    const Cell home = cell_of(place);
    for (int k = 0; k < int(std::pow(3, dim)); ++k) {
      Cell cell = home;
      for (int c = 0, rest = k; c < dim; ++c, rest /= 3)
        cell[c] += rest % 3 - 1;
      const auto found = cells_.find(cell);
      if (found != cells_.end() && std::any_of(found->second.begin(), found->second.end(), close))
        return true;
    }
    return false;
  }

  double distance_;
  Vector<dim> period_;
  std::map<Cell, std::vector<Vector<dim>>> cells_;
};
} // namespace ligament::dem
