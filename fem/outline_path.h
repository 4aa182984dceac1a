// The part of an outline that a layer of cells follows, and where its nodes lie on it.
#pragma once

#include "core/solid.h"

#include <functional>

namespace ligament::fem
{
/// A run of slanted sides between two that are lines of the mesh, or a whole closed loop. Places
/// along it are lengths in m from its beginning, the body on the left.
class OutlinePath
{
public:
  /// The one that a chain of nodes faces: `places` of these (m) and points a little outside them.
  /// Throws core::InputError where they face none, or a loop where the chain is open.
  OutlinePath(const core::Solid<2> &outline, const std::function<bool(int)> &is_slanted,
              const std::vector<Vector<2>> &places, const std::vector<Vector<2>> &outside,
              bool is_closed);

  struct Stop
  {
    double place;
    bool is_fixed; // at a corner or an end
  };
  /// A place for each node of the chain, growing along it; corners and ends have a node each. Of
  /// closed paths less than one length behind the first. Throws core::InputError where there are
  /// fewer nodes than corners.
  std::vector<Stop> stops(const std::vector<Vector<2>> &places,
                          const std::vector<Vector<2>> &outside) const;

  Vector<2> at(double place) const;
  int boundary_at(double place) const;
  int boundary_before() const { return boundary_before_; } // of the side that leads to the path
  int boundary_behind() const { return boundary_behind_; }
  /// Whether the body has a corner that sticks out where an open path leaves the side before it, or
  /// meets the one behind it.
  bool begins_outward() const { return begins_outward_; }
  bool ends_outward() const { return ends_outward_; }
  bool holds(double place) const { return is_closed_ || (place > 0 && place < length()); }
  double length() const { return start_.back(); }

private:
  /// A node of the chain and where it must be. Closed: nodes count on behind the last one.
  struct Fixed
  {
    int node;
    double place;
  };
  std::vector<Fixed> nodes_of_corners(const std::vector<Vector<2>> &places) const;
  std::vector<double> evened(std::vector<Fixed> fixed, const std::vector<double> &wish) const;
  double badness(const std::vector<Vector<2>> &places, const std::vector<double> &place) const;
  double nearest(const Vector<2> &x) const;
  std::size_t side_at(double &place) const;
  double turn(int facet, int next) const; // rad, to the left
  std::vector<double> corners() const;

  const core::Solid<2> &outline_;
  bool is_closed_;
  std::vector<int> facets_;
  std::vector<double> start_; // m, of each facet, and the end of the last one
  int boundary_before_ = 0, boundary_behind_ = 0;
  bool begins_outward_ = false, ends_outward_ = false;
};
} // namespace ligament::fem
