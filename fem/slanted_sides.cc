#include "fem/slanted_sides.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ligament::fem
{
std::vector<double> straight_sides(const core::Solid<2> &outline, int axis, double shortest)
{
  const double tolerance = 1e-9 * (outline.upper() - outline.lower()).maxCoeff();
  std::vector<std::pair<double, double>> sides; // place, length
  for (const auto &facet : outline.facets()) {
    const Vector<2> &a = outline.vertices()[facet.edges[0][0]],
                    &b = outline.vertices()[facet.edges[0][1]];
    if (std::abs(a[axis] - b[axis]) > tolerance)
      continue;
    const auto same = std::find_if(sides.begin(), sides.end(), [&](const auto &side) {
      return std::abs(side.first - a[axis]) <= tolerance;
    });
    if (same == sides.end())
      sides.emplace_back(a[axis], (b - a).norm());
    else
      same->second += (b - a).norm();
  }
  std::sort(sides.begin(), sides.end(),
            [](const auto &a, const auto &b) { return a.second > b.second; });
  std::vector<double> places;
  for (const auto &[place, length] : sides)
    if (length >= shortest)
      places.push_back(place);
  return places;
}

std::vector<double> ends_of_names(const core::Solid<2> &outline, int axis)
{
  const double tolerance = 1e-9 * (outline.upper() - outline.lower()).maxCoeff();
  const auto is_along = [&](const auto &facet) {
    const auto &[a, b] = facet.edges[0];
    return std::abs(outline.vertices()[a][1 - axis] - outline.vertices()[b][1 - axis]) <= tolerance;
  };
  std::map<int, int> boundary_behind; // by the vertex at which a side along the axis ends
  for (const auto &facet : outline.facets())
    if (is_along(facet))
      boundary_behind[facet.edges[0][1]] = facet.boundary;
  std::vector<double> places;
  for (const auto &facet : outline.facets())
    if (const auto before = boundary_behind.find(facet.edges[0][0]);
        before != boundary_behind.end() && is_along(facet) && before->second != facet.boundary)
      places.push_back(outline.vertices()[facet.edges[0][0]][axis]);
  return places;
}

SlantedSides::SlantedSides(const core::Solid<2> &outline,
                           const std::array<std::vector<double>, 2> &lines)
    : outline_(outline)
{
  const double tolerance = 1e-9 * (outline.upper() - outline.lower()).maxCoeff();
  for (const auto &facet : outline.facets()) {
    const Vector<2> &a = outline.vertices()[facet.edges[0][0]],
                    &b = outline.vertices()[facet.edges[0][1]];
    bool on_line = false;
    for (int axis = 0; axis < 2; ++axis)
      for (const double line : lines[axis])
        on_line = on_line ||
                  (std::abs(a[axis] - line) <= tolerance && std::abs(b[axis] - line) <= tolerance);
    slanted_.push_back(!on_line);
  }
}

bool SlantedSides::any() const
{
  return std::find(slanted_.begin(), slanted_.end(), 1) != slanted_.end();
}

bool SlantedSides::come_near(const Vector<2> &lower, const Vector<2> &upper, double distance) const
{
  const Vector<2> margin = Vector<2>::Constant(distance);
  const Vector<2> low = lower - margin, high = upper + margin;
  bool found = false;
  outline_.for_each_near(low, high, [&](int f) {
    if (found || !slanted_[f])
      return;
    const auto &edge = outline_.facets()[f].edges[0];
    const Vector<2> &a = outline_.vertices()[edge[0]], way = outline_.vertices()[edge[1]] - a;
    double from = 0, to = 1; // of the side, inside the box
    for (int c = 0; c < 2; ++c) {
      if (way[c] == 0)
        continue; // its box meets this one
      const double s = (low[c] - a[c]) / way[c], t = (high[c] - a[c]) / way[c];
      from = std::max(from, std::min(s, t));
      to = std::min(to, std::max(s, t));
    }
    found = from <= to;
  });
  return found;
}
} // namespace ligament::fem
