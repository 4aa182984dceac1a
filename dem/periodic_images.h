// The images of a body beyond joined sides, and the jumps of displacement from one to the next.
#pragma once

#include "core/check.h"
#include "dem/bond.h"

#include <memory>

namespace ligament::dem
{
/// Bonds keep the addresses of their images, which stay.
template <int dim>
class PeriodicImages
{
public:
  /// Periods in m; 0 along axes that have none.
  explicit PeriodicImages(const Vector<dim> &period) : period_(period)
  {
    if (!is_any())
      return;
    for (int k = 0; k < number; ++k) {
      auto &image = images_.emplace_back(std::make_unique<PeriodicImage<dim>>());
      for (int a = 0, rest = k; a < dim; ++a, rest /= 3) {
        image->periods[a] = rest % 3 - 1;
        image->offset[a] = image->periods[a] * period[a];
      }
    }
    for (int k = 0; k < number; ++k)
      images_[k]->opposite = images_[number - 1 - k].get();
  }

  bool is_any() const { return period_.maxCoeff() > 0; }
  const Vector<dim> &period() const { return period_; }

  /// Null: no image.
  const PeriodicImage<dim> *of(const std::array<int, dim> &periods) const
  {
    int k = 0, place = 1;
    bool is_own = true;
    for (int a = 0; a < dim; ++a, place *= 3) {
      core::require(std::abs(periods[a]) <= (period_[a] > 0),
                    "a packing refers to an image that it has not");
      k += (periods[a] + 1) * place;
      is_own = is_own && periods[a] == 0;
    }
    return is_own ? nullptr : images_[k].get();
  }

  /// Their numbers in files: they do not depend on which sides are joined. -1: none.
  static int number_of(const PeriodicImage<dim> *image)
  {
    int k = 0;
    for (int a = dim - 1; image && a >= 0; --a)
      k = 3 * k + image->periods[a] + 1;
    return image ? k : -1;
  }
  const PeriodicImage<dim> *of(int number) const
  {
    return number < 0 || images_.empty() ? nullptr : images_[number].get();
  }

  /// visit(const PeriodicImage<dim> *) for all of them.
  template <typename Visit>
  void for_each(Visit &&visit) const
  {
    for (const auto &image : images_) {
      bool exists = image.get() != image->opposite;
      for (int a = 0; a < dim; ++a)
        exists = exists && (period_[a] > 0 || image->periods[a] == 0);
      if (exists)
        visit(image.get());
    }
  }

  /// One jump for each axis, in m: the image one period further has it in addition.
  void set_jumps(const std::array<Vector<dim>, dim> &jump)
  {
    for (const auto &image : images_) {
      image->jump.setZero();
      for (int a = 0; a < dim; ++a)
        image->jump += image->periods[a] * jump[a];
    }
  }

  /// The same, as they are.
  std::array<Vector<dim>, dim> jumps() const
  {
    std::array<Vector<dim>, dim> jumps;
    jumps.fill(Vector<dim>::Zero());
    for (int a = 0; a < dim; ++a)
      if (std::array<int, dim> next = {}; period_[a] > 0) {
        next[a] = 1;
        jumps[a] = of(next)->jump;
      }
    return jumps;
  }

private:
  static constexpr int number = dim == 2 ? 9 : 27;

  Vector<dim> period_;
  std::vector<std::unique_ptr<PeriodicImage<dim>>> images_;
};
} // namespace ligament::dem
