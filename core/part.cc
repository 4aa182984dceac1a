#include "core/part.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace ligament::core
{
namespace
{
/// What of a convex face lies where normal . x <= offset.
template <int dim>
FaceCorners<dim> below(const FaceCorners<dim> &face, const Vector<dim> &normal, double offset)
{
  FaceCorners<dim> kept;
  const std::size_t n = face.size();
  if (n == 0)
    return kept;
  if (std::all_of(face.begin(), face.end(), [&](const auto &x) { return normal.dot(x) <= offset; }))
    return face;
  const std::size_t n_edges = dim == 2 ? n - 1 : n; // a segment is not closed
  for (std::size_t k = 0; k < n_edges; ++k) {
    const Vector<dim> &a = face[k], &b = face[(k + 1) % n];
    const double over_a = normal.dot(a) - offset, over_b = normal.dot(b) - offset;
    if (over_a <= 0)
      kept.push_back(a);
    if ((over_a < 0 && over_b > 0) || (over_a > 0 && over_b < 0))
      kept.push_back(a + over_a / (over_a - over_b) * (b - a));
    if (dim == 2 && over_b <= 0)
      kept.push_back(b);
  }
  if (kept.size() < std::size_t(dim))
    kept.clear();
  return kept;
}

constexpr int slanted = -1;

/// The axis across the face.
template <int dim>
int axis_across(const FaceCorners<dim> &face)
{
  Vector<dim> least = face[0], most = face[0];
  for (const auto &x : face) {
    least = least.cwiseMin(x);
    most = most.cwiseMax(x);
  }
  int axis = 0;
  const double depth = (most - least).minCoeff(&axis);
  return depth <= 1e-9 * (most - least).maxCoeff() ? axis : slanted;
}

/// What of a segment lies in the disc.
FaceCorners<2> inside_circle(const FaceCorners<2> &segment, const Vector<2> &centre, double radius)
{
  const Vector<2> along = (segment[1] - segment[0]).normalized();
  const double length = (segment[1] - segment[0]).norm();
  const double foot = along.dot(centre - segment[0]);
  const double apart = (segment[0] + foot * along - centre).norm();
  if (apart >= radius)
    return {};
  const double half = std::sqrt(radius * radius - apart * apart);
  const double from = std::max(0., foot - half), to = std::min(length, foot + half);
  if (from >= to)
    return {};
  return {segment[0] + from * along, to < length ? Vector<2>(segment[0] + to * along) : segment[1]};
}

constexpr int disc_sides = 96;

template <int dim>
FaceCorners<dim> inside_disc(FaceCorners<dim> face, const Vector<dim> &centre, int axis,
                             double radius)
{
  if constexpr (dim == 2) {
    const Vector<2> along = Vector<2>::Unit(1 - axis);
    face = below<2>(face, along, along.dot(centre) + radius);
    return below<2>(face, -along, radius - along.dot(centre));
  } else {
    const Vector<3> u = Vector<3>::Unit((axis + 1) % 3), v = Vector<3>::Unit((axis + 2) % 3);
    // Half the angle of a side; the polygon's area is n r^2 tan, r to the middle of a side.
    const double half = M_PI / disc_sides;
    const double inner = radius * std::sqrt(half / std::tan(half));
    for (int k = 0; k < disc_sides && !face.empty(); ++k) {
      const Vector<3> normal = std::cos(2 * k * half) * u + std::sin(2 * k * half) * v;
      face = below<3>(face, normal, normal.dot(centre) + inner);
    }
    return face;
  }
}
} // namespace

template <int dim>
double face_area(const FaceCorners<dim> &corners)
{
  if (corners.size() < std::size_t(dim))
    return 0;
  if constexpr (dim == 2)
    return (corners[1] - corners[0]).norm();
  else {
    Vector<3> sum = Vector<3>::Zero();
    for (std::size_t k = 2; k < corners.size(); ++k)
      sum += (corners[k - 1] - corners[0]).cross(corners[k] - corners[0]) / 2;
    return sum.norm();
  }
}

template <int dim>
Vector<dim> face_centroid(const FaceCorners<dim> &corners)
{
  if constexpr (dim == 2)
    return (corners[0] + corners[1]) / 2;
  else {
    Vector<3> moment = Vector<3>::Zero(), middle = Vector<3>::Zero(), normal = moment;
    double area = 0;
    const auto triangle = [&](std::size_t k) {
      return std::pair<Vector<3>, Vector<3>>(corners[k - 1] - corners[0], corners[k] - corners[0]);
    };
    for (std::size_t k = 0; k < corners.size(); ++k)
      middle += corners[k] / double(corners.size());
    for (std::size_t k = 2; k < corners.size(); ++k) {
      const auto [a, b] = triangle(k);
      normal += a.cross(b);
    }
    normal.normalize();
    for (std::size_t k = 2; k < corners.size(); ++k) { // below 0 beside a re-entrant corner
      const auto [a, b] = triangle(k);
      const double part = normal.dot(a.cross(b)) / 2;
      area += part;
      moment += part * (a + b) / 3;
    }
    return area > 0 ? Vector<3>(corners[0] + moment / area) : middle;
  }
}

template <int dim>
FaceCorners<dim> side_corners(const Vector<dim> &lower, const Vector<dim> &upper, int side)
{
  const int axis = side / 2;
  const double place = side % 2 ? upper[axis] : lower[axis];
  FaceCorners<dim> corners;
  const auto add = [&](bool first, bool second) {
    Vector<dim> x;
    x[axis] = place;
    x[(axis + 1) % dim] = first ? upper[(axis + 1) % dim] : lower[(axis + 1) % dim];
    if (dim == 3)
      x[(axis + 2) % dim] = second ? upper[(axis + 2) % dim] : lower[(axis + 2) % dim];
    corners.push_back(x);
  };
  add(false, false);
  add(true, false);
  if (dim == 3) {
    add(true, true);
    add(false, true);
  }
  return corners;
}

template <int dim>
Part<dim> Part<dim>::box(const Vector<dim> &lower, const Vector<dim> &upper)
{
  Part part;
  part.shape_ = Shape::box;
  part.lower_ = lower;
  part.upper_ = upper;
  return part;
}

template <int dim>
Part<dim> Part<dim>::ball(const Vector<dim> &centre, double radius)
{
  Part part;
  part.shape_ = Shape::ball;
  part.lower_ = part.upper_ = centre;
  part.radius_ = radius;
  return part;
}

template <int dim>
bool Part<dim>::holds(const Vector<dim> &x, double tolerance) const
{
  switch (shape_) {
  case Shape::box:
    return (x.array() >= lower_.array() - tolerance).all() &&
           (x.array() <= upper_.array() + tolerance).all();
  case Shape::ball:
    return (x - lower_).norm() <= radius_ + tolerance;
  case Shape::whole:
    break;
  }
  return true;
}

template <int dim>
FaceCorners<dim> Part<dim>::clip(FaceCorners<dim> face) const
{
  if (shape_ == Shape::whole || face.empty())
    return face;
  const int axis = axis_across<dim>(face);
  if (axis == slanted)
    return clip_slanted(std::move(face));
  const double place = face[0][axis];
  if (shape_ == Shape::ball) {
    const double height = place - lower_[axis];
    return std::abs(height) >= radius_
               ? FaceCorners<dim>()
               : inside_disc<dim>(std::move(face), lower_, axis,
                                  std::sqrt(radius_ * radius_ - height * height));
  }
  // A side that the box just touches belongs to it, whatever round-off says.
  double size = 0;
  for (const auto &x : face)
    size = std::max(size, (x - face[0]).norm());
  const double tolerance = 1e-9 * (size + std::abs(place));
  if (place < lower_[axis] - tolerance || place > upper_[axis] + tolerance)
    return {};
  for (int c = 0; c < dim; ++c)
    if (c != axis) {
      if (std::isfinite(upper_[c]))
        face = below<dim>(face, Vector<dim>::Unit(c), upper_[c]);
      if (std::isfinite(lower_[c]))
        face = below<dim>(face, -Vector<dim>::Unit(c), -lower_[c]);
    }
  return face;
}

template <int dim>
FaceCorners<dim> Part<dim>::clip_slanted(FaceCorners<dim> face) const
{
  if constexpr (dim == 3)
    return holds(face_centroid<3>(face), 0) ? face : FaceCorners<3>();
  else {
    if (shape_ == Shape::ball)
      return inside_circle(face, lower_, radius_);
    for (int c = 0; c < dim; ++c) {
      if (std::isfinite(upper_[c]))
        face = below<dim>(face, Vector<dim>::Unit(c), upper_[c]);
      if (std::isfinite(lower_[c]))
        face = below<dim>(face, -Vector<dim>::Unit(c), -lower_[c]);
    }
    return face;
  }
}

template double face_area<2>(const FaceCorners<2> &);
template double face_area<3>(const FaceCorners<3> &);
template Vector<2> face_centroid<2>(const FaceCorners<2> &);
template Vector<3> face_centroid<3>(const FaceCorners<3> &);
template FaceCorners<2> side_corners<2>(const Vector<2> &, const Vector<2> &, int);
template FaceCorners<3> side_corners<3>(const Vector<3> &, const Vector<3> &, int);
template class Part<2>;
template class Part<3>;
} // namespace ligament::core
