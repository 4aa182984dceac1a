// Places by bins, so that those near a point are found without a look at all.
#pragma once

#include "core/types.h"

#include <array>
#include <cmath>
#include <map>
#include <vector>

namespace ligament::program
{
template <int dim>
class NearPlaces
{
public:
  /// `reach` in m: what is near.
  explicit NearPlaces(double reach) : reach_(reach) {}

  double reach() const { return reach_; }
  int size() const { return int(places_.size()); }
  const Vector<dim> &operator[](int k) const { return places_[k]; }

  void add(const Vector<dim> &place)
  {
    bins_[bin_of(place)].push_back(size());
    places_.push_back(place);
  }

  /// visit(k) for all within reach of the point.
  template <typename Visit>
  void for_each_near(const Vector<dim> &point, Visit &&visit) const
  {
    const Bin bin = bin_of(point);
    for (int k = 0; k < (dim == 2 ? 9 : 27); ++k) {
      Bin other = bin;
      for (int c = 0, rest = k; c < dim; ++c, rest /= 3)
        other[c] += rest % 3 - 1;
      const auto found = bins_.find(other);
      if (found == bins_.end())
        continue;
      for (const int near : found->second)
        if ((places_[near] - point).norm() <= reach_)
          visit(near);
    }
  }

private:
  using Bin = std::array<long, dim>;
  Bin bin_of(const Vector<dim> &x) const
  {
    Bin bin;
    for (int c = 0; c < dim; ++c)
      bin[c] = long(std::floor(x[c] / reach_));
    return bin;
  }

  double reach_;
  std::vector<Vector<dim>> places_;
  std::map<Bin, std::vector<int>> bins_;
};
} // namespace ligament::program
