// What of a solid lies in a convex cell: its closed surface, cut by one plane after another.
#pragma once

#include "core/solid.h"

#include <limits>

namespace ligament::packings
{
/// A closed chain of plane faces, not convex as a rule and in several parts perhaps. Each face is a
/// bag of directed edges that close it. Nothing is linked to loops: areas and moments are sums over
/// edges, and what was closed stays closed whatever the round-off.
template <int dim>
class SolidPiece
{
public:
  struct Face
  {
    int id;
    Vector<dim> normal; // unit, outward
    double distance;    // m, from the origin to the plane
    double area;        // m^(dim-1)
    Vector<dim> moment; // area times centroid
  };

  SolidPiece() = default;
  /// All of the solid, about the origin; its k-th facet has the id first - k.
  SolidPiece(const core::Solid<dim> &solid, int first);

  /// Keeps the part with normal . x <= distance (m) and closes it by a face with this id. Points
  /// within the tolerance in m of the plane count as inside.
  void clip(const Vector<dim> &normal, double distance, int id, double tolerance);
  /// Moves it all by x.
  void shift(const Vector<dim> &x);

  /// Faces of no area may be among them.
  std::vector<Face> faces() const;
  /// In turn, of 3D face number k, in m; empty where it is not one loop.
  std::vector<Vector<dim>> corners(std::size_t k) const;
  const std::vector<Vector<dim>> &vertices() const { return vertices_; } // m

private:
  using Edge = std::array<int, 2>;
  struct Bag
  {
    int id;
    Vector<dim> normal;
    std::vector<Edge> edges;
  };

  std::vector<Vector<dim>> vertices_;
  std::vector<Bag> faces_;
};

/// Id of faces where a piece ends but the solid goes on.
inline constexpr int border_of_piece = std::numeric_limits<int>::min();

/// The pieces of a solid near its surface, found by place: cells need not be cut from the whole.
template <int dim>
class SolidPieces
{
public:
  /// For cells that reach up to so far (m) from a point.
  SolidPieces(const core::Solid<dim> &solid, int first_id, double reach);

  /// A piece that holds all of the solid within the reach of x, about x; empty where the surface is
  /// farther.
  SolidPiece<dim> around(const Vector<dim> &x) const;

private:
  using Index = std::array<int, dim>;
  Index bin_of(const Vector<dim> &x) const;

  double bin_; // m
  Vector<dim> lower_;
  Index n_bins_;
  std::vector<SolidPiece<dim>> piece_; // of each bin and what is within reach of it
};
} // namespace ligament::packings
