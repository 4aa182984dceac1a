// Which sides of an outline a grid of boxes can have as its lines, and which not.
#pragma once

#include "core/solid.h"

#include <vector>

namespace ligament::fem
{
/// Coordinates along the axis of the outline's straight sides across it that are at least so long
/// in all (m), the longest first: where lines of the mesh may lie.
std::vector<double> straight_sides(const core::Solid<2> &outline, int axis, double shortest);

/// Coordinates along the axis at which one named part of a straight side along it ends and another
/// begins: loads do, too.
std::vector<double> ends_of_names(const core::Solid<2> &outline, int axis);

/// Whether a side of the outline that lies on none of the lines comes nearer to the box than a
/// distance in m.
class SlantedSides
{
public:
  SlantedSides(const core::Solid<2> &outline, const std::array<std::vector<double>, 2> &lines);
  bool is_slanted(int facet) const { return slanted_[facet]; }
  bool any() const;
  void add(int facet) { slanted_[facet] = 1; }
  bool come_near(const Vector<2> &lower, const Vector<2> &upper, double distance) const;

private:
  const core::Solid<2> &outline_;
  std::vector<char> slanted_;
};
} // namespace ligament::fem
