// A part of a side of the specimen: all of it, what lies in a box, or what lies in a ball.
#pragma once

#include "core/types.h"

namespace ligament::core
{
/// Corners of a convex plane face in turn; in 2D the two ends of a segment.
template <int dim>
using FaceCorners = std::vector<Vector<dim>>;

/// Length (2D) or area (3D) of a face.
template <int dim>
double face_area(const FaceCorners<dim> &corners);
template <int dim>
Vector<dim> face_centroid(const FaceCorners<dim> &corners);

/// The corners of a side of a box, numbered as in core/types.h.
template <int dim>
FaceCorners<dim> side_corners(const Vector<dim> &lower, const Vector<dim> &upper, int side);

/// Axis-parallel faces, and all in 2D, are clipped exactly. A ball meets a side of a 3D specimen in
/// a disc: a regular polygon of 96 sides and the disc's area takes its place.
template <int dim>
class Part
{
public:
  /// Everything.
  Part() = default;
  /// In m; sides may be infinite.
  static Part box(const Vector<dim> &lower, const Vector<dim> &upper);
  static Part ball(const Vector<dim> &centre, double radius);

  bool is_whole() const { return shape_ == Shape::whole; }
  /// Up to a tolerance in m, which belongs to it.
  bool holds(const Vector<dim> &x, double tolerance) const;
  /// What of a face lies inside; empty when nothing does. Faces in 3D that are not axis-parallel
  /// are not cut: inside are those whose centroid is.
  FaceCorners<dim> clip(FaceCorners<dim> face) const;

  friend bool operator==(const Part &a, const Part &b)
  {
    return a.shape_ == b.shape_ && a.lower_ == b.lower_ && a.upper_ == b.upper_ &&
           a.radius_ == b.radius_;
  }

private:
  FaceCorners<dim> clip_slanted(FaceCorners<dim> face) const;

  enum class Shape
  {
    whole,
    box,
    ball
  };
  Shape shape_ = Shape::whole;
  Vector<dim> lower_ = Vector<dim>::Zero(), upper_ = Vector<dim>::Zero(); // ball: both its centre
  double radius_ = 0;
};
} // namespace ligament::core
