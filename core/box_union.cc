#include "core/box_union.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ligament::core
{
namespace
{
constexpr double infinity = std::numeric_limits<double>::infinity();

/// A point between the two, which may be infinite.
double between(double a, double b)
{
  if (std::isinf(a) && std::isinf(b))
    return 0;
  if (std::isinf(a))
    return b - std::abs(b) - 1;
  if (std::isinf(b))
    return a + std::abs(a) + 1;
  return a + (b - a) / 2;
}

/// Visits the boxes of a tensor grid, until the visit returns false.
template <int dim, typename Visit>
bool for_all_boxes(const std::array<std::vector<double>, dim> &ends, Visit &&visit)
{
  std::size_t n = 1;
  for (const auto &e : ends)
    n *= e.size() - 1;
  for (std::size_t i = 0; i < n; ++i) {
    typename BoxUnion<dim>::Box box;
    std::size_t rest = i;
    for (int c = 0; c < dim; ++c) {
      const std::size_t k = rest % (ends[c].size() - 1);
      rest /= ends[c].size() - 1;
      box.lower[c] = ends[c][k];
      box.upper[c] = ends[c][k + 1];
    }
    if (!visit(box))
      return false;
  }
  return true;
}
} // namespace

/// The interval's ends and the sides of boxes strictly between.
template <int dim>
std::vector<double> BoxUnion<dim>::cuts(int axis, double lower, double upper) const
{
  std::vector<double> ends{lower, upper};
  for (const Box &box : boxes)
    for (const double side : {box.lower[axis], box.upper[axis]})
      if (side > lower && side < upper)
        ends.push_back(side);
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  return ends;
}

template <int dim>
bool BoxUnion<dim>::covers(const Vector<dim> &lower, const Vector<dim> &upper,
                           double tolerance) const
{
  const auto is_in = [&](const Box &box) {
    return (box.lower.array() <= lower.array() + tolerance).all() &&
           (box.upper.array() >= upper.array() - tolerance).all();
  };
  if (boxes.size() == 1)
    return is_in(boxes[0]);
  if (std::any_of(boxes.begin(), boxes.end(), is_in))
    return true;
  std::array<std::vector<double>, dim> ends;
  for (int c = 0; c < dim; ++c) {
    const double shrink = std::min(tolerance, (upper[c] - lower[c]) / 4);
    ends[c] = cuts(c, lower[c] + shrink, upper[c] - shrink);
    if (ends[c].size() == 1)
      ends[c].push_back(ends[c][0]); // a point
  }
  return for_all_boxes<dim>(ends, [&](const Box &part) {
    Vector<dim> x;
    for (int c = 0; c < dim; ++c)
      x[c] = between(part.lower[c], part.upper[c]);
    return std::any_of(boxes.begin(), boxes.end(), [&](const Box &box) {
      return (box.lower.array() <= x.array()).all() && (box.upper.array() >= x.array()).all();
    });
  });
}

template <int dim>
bool BoxUnion<dim>::meets(const Vector<dim> &lower, const Vector<dim> &upper,
                          double tolerance) const
{
  return std::any_of(boxes.begin(), boxes.end(), [&](const Box &box) {
    return (box.lower.array() < upper.array() - tolerance).all() &&
           (box.upper.array() > lower.array() + tolerance).all();
  });
}

template <int dim>
double BoxUnion<dim>::distance(const Vector<dim> &x) const
{
  double outside = infinity;
  for (const Box &box : boxes)
    outside = std::min(outside, (box.lower - x).cwiseMax(x - box.upper).maxCoeff());
  if (outside > 0 || boxes.size() == 1)
    return -outside;
  // The cube stops growing at a side of some box.
  std::vector<double> radii;
  for (const Box &box : boxes)
    for (int c = 0; c < dim; ++c)
      for (const double side : {box.lower[c], box.upper[c]})
        if (std::isfinite(side))
          radii.push_back(std::abs(side - x[c]));
  std::sort(radii.begin(), radii.end());
  const auto end = std::partition_point(radii.begin(), radii.end(), [&](double radius) {
    const Vector<dim> half = Vector<dim>::Constant(radius);
    return covers(x - half, x + half, 1e-12 * radius);
  });
  return end == radii.begin() ? 0 : *(end - 1);
}

template <int dim>
BoxUnion<dim> BoxUnion<dim>::eroded(double distance) const
{
  std::array<std::vector<double>, dim> ends;
  for (int c = 0; c < dim; ++c) {
    ends[c] = {-infinity, infinity};
    for (const Box &box : boxes)
      for (const double side : {box.lower[c] + distance, box.upper[c] - distance})
        if (std::isfinite(side))
          ends[c].push_back(side);
    std::sort(ends[c].begin(), ends[c].end());
    ends[c].erase(std::unique(ends[c].begin(), ends[c].end()), ends[c].end());
  }
  BoxUnion result;
  for_all_boxes<dim>(ends, [&](const Box &part) {
    Vector<dim> x;
    for (int c = 0; c < dim; ++c)
      x[c] = between(part.lower[c], part.upper[c]);
    if (this->distance(x) > distance)
      result.boxes.push_back(part);
    return true;
  });
  // Join what lies side by side, so that no cut is left without need.
  for (int axis = 0; axis < dim; ++axis)
    for (std::size_t i = 0; i < result.boxes.size(); ++i)
      for (std::size_t j = 0; j < result.boxes.size(); ++j) {
        Box &a = result.boxes[i];
        const Box &b = result.boxes[j];
        bool fits = i != j && a.upper[axis] == b.lower[axis];
        for (int c = 0; c < dim; ++c)
          fits = fits && (c == axis || (a.lower[c] == b.lower[c] && a.upper[c] == b.upper[c]));
        if (!fits)
          continue;
        a.upper[axis] = b.upper[axis];
        result.boxes.erase(result.boxes.begin() + j);
        i -= j < i;
        j = std::size_t(-1); // from the start
      }
  return result;
}

template struct BoxUnion<2>;
template struct BoxUnion<3>;
} // namespace ligament::core
