#include "src/scene/geometry.h"

#include <algorithm>
#include <cmath>

namespace ligament::program
{
int fine_cells(const Scene &scene)
{
  if (scene.far_field->fine_cells > 0)
    return scene.far_field->fine_cells;
  return scene.coupling.overlap_cells + scene.coupling.transition_cells + 2;
}

namespace
{
Point difference(const Point &a, const Point &b)
{
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Point cross(const Point &a, const Point &b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Point &a, const Point &b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double norm(const Point &a)
{
  return std::sqrt(dot(a, a));
}

/// Sutherland-Hodgman: the part with sign * (p[axis] - position) <= 0.
std::vector<Point> clip_half(const std::vector<Point> &corners, int axis, double position,
                             double sign)
{
  std::vector<Point> kept;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Point &a = corners[k], &b = corners[(k + 1) % corners.size()];
    const double out_a = sign * (a[axis] - position), out_b = sign * (b[axis] - position);
    if (out_a <= 0)
      kept.push_back(a);
    if ((out_a < 0 && out_b > 0) || (out_a > 0 && out_b < 0)) {
      Point p;
      for (int c = 0; c < 3; ++c)
        p[c] = a[c] + (b[c] - a[c]) * out_a / (out_a - out_b);
      p[axis] = position;
      kept.push_back(p);
    }
  }
  return kept;
}

/// Twice the area times the normal of the polygon.
Point area_vector(const std::vector<Point> &corners)
{
  Point sum = {0, 0, 0};
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
    const Point n =
        cross(difference(corners[k], corners[0]), difference(corners[k + 1], corners[0]));
    for (int c = 0; c < 3; ++c)
      sum[c] += n[c];
  }
  return sum;
}
} // namespace

std::vector<Point> clip(const std::vector<Point> &corners, const Box &box, int dim)
{
  std::vector<Point> kept = corners;
  for (int axis = 0; axis < dim; ++axis) {
    kept = clip_half(kept, axis, box.lower[axis], -1);
    kept = clip_half(kept, axis, box.upper[axis], 1);
  }
  return kept;
}

bool crosses(const Crack &crack, const Point &a, const Point &b, int dim)
{
  const std::vector<Point> &p = crack.points;
  if (dim == 2 && p.size() > 2) {
    bool any = false;
    for (std::size_t k = 1; k < p.size(); ++k)
      any = any || crosses(Crack{{p[k - 1], p[k]}}, a, b, dim);
    return any;
  }
  // In 2D the segment reaches across the plane: its normal lies in it.
  const Point along = difference(p[1], p[0]);
  const Point n = dim == 2 ? Point{-along[1], along[0], 0} : area_vector(p);
  const double at_a = dot(n, difference(a, p[0])), at_b = dot(n, difference(b, p[0]));
  if (at_a * at_b > 0 || (at_a == at_b && at_a != 0))
    return false;
  Point at = a;
  for (int c = 0; c < 3 && at_a != at_b; ++c)
    at[c] += (b[c] - a[c]) * at_a / (at_a - at_b);
  if (dim == 2) {
    const double share = dot(along, difference(at, p[0])) / dot(along, along);
    return share >= 0 && share <= 1;
  }
  for (std::size_t k = 0; k < p.size(); ++k) {
    const Point edge = difference(p[(k + 1) % p.size()], p[k]);
    if (dot(n, cross(edge, difference(at, p[k]))) < 0)
      return false;
  }
  return true;
}

Box bounding_box(const std::vector<Point> &points)
{
  Box box{points.front(), points.front()};
  for (const Point &p : points)
    for (int c = 0; c < 3; ++c) {
      box.lower[c] = std::min(box.lower[c], p[c]);
      box.upper[c] = std::max(box.upper[c], p[c]);
    }
  return box;
}

double diameter(const std::vector<Point> &points)
{
  double largest = 0;
  for (const Point &a : points)
    for (const Point &b : points)
      largest = std::max(largest, norm(difference(a, b)));
  return largest;
}

double polygon_area(const std::vector<Point> &corners)
{
  return norm(area_vector(corners)) / 2;
}

bool is_plane(const std::vector<Point> &corners)
{
  const Point n = area_vector(corners);
  const double tolerance = 1e-6 * diameter(corners) * norm(n);
  return std::all_of(corners.begin(), corners.end(), [&](const Point &p) {
    return std::abs(dot(n, difference(p, corners[0]))) <= tolerance;
  });
}

bool is_convex(const std::vector<Point> &corners)
{
  const Point n = area_vector(corners);
  const std::size_t size = corners.size();
  for (std::size_t k = 0; k < size; ++k) {
    const Point first = difference(corners[(k + 1) % size], corners[k]);
    const Point second = difference(corners[(k + 2) % size], corners[(k + 1) % size]);
    if (dot(n, cross(first, second)) < -1e-9 * dot(n, n))
      return false;
  }
  return true;
}

template <int dim>
bool is_in_regions(const Specimen &specimen, const std::vector<Hole> &balls,
                   const std::vector<Notch> &boxes, const Vector<dim> &x)
{
  for (int k = 0; k < (dim == 2 ? 9 : 27); ++k) {
    Vector<dim> image = x;
    bool exists = true;
    for (int a = 0, rest = k; a < dim; ++a, rest /= 3) {
      exists = exists && (rest % 3 == 1 || specimen.is_periodic(a));
      image[a] += (rest % 3 - 1) * specimen.size[a];
    }
    const auto in_ball = [&](const Hole &ball) {
      return (image - Vector<dim>(ball.centre.data())).norm() < ball.radius;
    };
    const auto in_box = [&](const Notch &box) {
      return (image.array() > Vector<dim>(box.lower.data()).array()).all() &&
             (image.array() < Vector<dim>(box.upper.data()).array()).all();
    };
    if (exists && (std::any_of(balls.begin(), balls.end(), in_ball) ||
                   std::any_of(boxes.begin(), boxes.end(), in_box)))
      return true;
  }
  return false;
}

template bool is_in_regions(const Specimen &, const std::vector<Hole> &, const std::vector<Notch> &,
                            const Vector<2> &);
template bool is_in_regions(const Specimen &, const std::vector<Hole> &, const std::vector<Notch> &,
                            const Vector<3> &);
} // namespace ligament::program
