// A body bounded by flat facets: closed outlines in 2D, closed surfaces in 3D.
#pragma once

#include "core/types.h"

#include <array>
#include <limits>

namespace ligament::core
{
/// What is inside follows from the facets alone: they are oriented and leave no gap. There may be
/// several pieces, with any number of holes.
template <int dim>
class Solid
{
public:
  using Edge = std::array<int, 2>; // from a vertex to another

  /// 2D: one edge, with the body on its left. 3D: a plane polygon, with holes perhaps, its edges
  /// counter-clockwise round it and clockwise round its holes, seen from outside.
  struct Facet
  {
    std::vector<Edge> edges;
    int boundary; // core/types.h
  };

  /// Vertices in m. Throws core::InputError, naming a place, where facets leave a gap or one side
  /// of an edge has two, and where a facet is degenerate.
  Solid(std::vector<Vector<dim>> vertices, std::vector<Facet> facets);

  const std::vector<Vector<dim>> &vertices() const { return vertices_; }
  const std::vector<Facet> &facets() const { return facets_; }
  const Vector<dim> &normal(int facet) const { return normal_[facet]; } // unit, outward
  /// m, of the plane of a facet: normal . x.
  double offset(int facet) const
  {
    return normal_[facet].dot(vertices_[facets_[facet].edges[0][0]]);
  }
  const Vector<dim> &lower() const { return lower_; } // m, of the smallest box around it
  const Vector<dim> &upper() const { return upper_; }
  double volume() const; // m^dim

  bool contains(const Vector<dim> &x) const;
  /// From x to the surface in m, negative outside; not beyond +-limit.
  double distance(const Vector<dim> &x, double limit) const;

  struct Foot
  {
    int facet = -1; // none within the limit
    Vector<dim> place = Vector<dim>::Zero();
    double distance = 0; // m, not signed
  };
  /// The point of the surface that is nearest to x, within the limit in m.
  Foot nearest(const Vector<dim> &x, double limit = std::numeric_limits<double>::infinity()) const;

  /// visit(facet) once for each facet whose box meets [lower, upper]; the order is that of their
  /// numbers.
  template <typename Visit>
  void for_each_near(const Vector<dim> &lower, const Vector<dim> &upper, Visit &&visit) const
  {
    for (const int f : near(lower, upper))
      visit(f);
  }

private:
  using Index = std::array<int, dim>;
  void check_closed() const;
  void sort_into_bins();
  Index bin_of(const Vector<dim> &x) const;
  std::vector<int> near(const Vector<dim> &lower, const Vector<dim> &upper) const;
  Vector<dim> foot_on(int facet, const Vector<dim> &x) const;

  std::vector<Vector<dim>> vertices_, normal_, facet_lower_, facet_upper_;
  std::vector<Facet> facets_;
  Vector<dim> lower_, upper_;
  double bin_ = 0;
  Index n_bins_;
  std::vector<std::vector<int>> in_bin_, in_column_; // facets; columns run along x
};
} // namespace ligament::core
