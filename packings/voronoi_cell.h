// A small convex polygon or polyhedron that is cut by half-spaces: Voronoi cells and what voids
// take from them.
#pragma once

#include "core/types.h"

namespace ligament::packings
{
/// Convex polytope around the origin. Each of its faces remembers the plane that made it.
/// Lengths in m (any unit, as long as it is the same for all).
template <int dim>
class VoronoiCell
{
public:
  struct Face
  {
    int id;
    Vector<dim> normal; // unit, outward
    double distance;    // from the origin to the plane
    double area;
    Vector<dim> centroid;
  };

  /// A cube from -half_width to half_width, all of whose faces carry `id`. Points closer than
  /// `tolerance` to a plane count as inside it, so that planes that only touch don't cut.
  VoronoiCell(double half_width, int id, double tolerance);

  /// Would the half-space normal . x <= distance take anything away?
  bool is_cut_by(const Vector<dim> &normal, double distance) const;

  /// Keeps the part with normal . x <= distance; the new face carries `id`.
  void clip(const Vector<dim> &normal, double distance, int id);

  bool is_empty() const { return vertices_.empty(); }
  double max_radius() const { return max_radius_; }
  const std::vector<Vector<dim>> &vertices() const { return vertices_; }
  double volume() const;
  /// Volume times centroid.
  Vector<dim> moment() const;
  /// Degenerate faces may come with zero area; an id may come more than once.
  std::vector<Face> faces() const;
  /// Corners of the k-th of them in turn.
  std::vector<Vector<dim>> corners(std::size_t k) const;

private:
  struct Plane
  {
    int id;
    Vector<dim> normal;
    double distance;
    /// Vertices in turn, counter-clockwise seen from outside; 2D: start and end of the edge.
    std::vector<int> loop;
  };

  void update_radius();

  double tolerance_;
  double max_radius_ = 0;
  std::vector<Vector<dim>> vertices_;
  std::vector<Plane> planes_;

  // Work space of clip, kept to spare allocations.
  struct Cut
  {
    int inside, outside, vertex;
  };
  std::vector<double> excess_;
  std::vector<int> new_index_, next_on_cap_;
  std::vector<Cut> cuts_;
};
} // namespace ligament::packings
