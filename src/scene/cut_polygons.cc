#include "src/scene/cut_polygons.h"

#include "core/keyed_error.h"

#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>

#include <fmt/format.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
using core::Polygon;

namespace bg = boost::geometry;
using BoostPoint = bg::model::d2::point_xy<double>;
using BoostPolygon = bg::model::polygon<BoostPoint, false, false>; // counter-clockwise, open
using BoostPolygons = bg::model::multi_polygon<BoostPolygon>;

/// Places as Boost.Geometry is given them, from -1 to 1: it drops what has an area of the order of
/// its numbers' precision, in whatever unit and wherever the body lies.
class Frame
{
public:
  explicit Frame(const std::vector<Polygon> &polygons)
  {
    Eigen::AlignedBox2d box;
    for (const Polygon &polygon : polygons)
      for (const auto &corner : polygon)
        box.extend(corner.place);
    middle_ = box.center();
    size_ = box.sizes().maxCoeff() / 2;
  }

  double size() const { return size_; } // m
  BoostPolygon inward(const Polygon &polygon) const
  {
    BoostPolygon result;
    for (const auto &corner : polygon) {
      const Vector<2> x = (corner.place - middle_) / size_;
      result.outer().emplace_back(x[0], x[1]);
    }
    return result;
  }
  Vector<2> outward(const BoostPoint &x) const { return middle_ + size_ * Vector<2>(x.x(), x.y()); }

private:
  Vector<2> middle_; // m
  double size_;
};

/// The boundary of the polygon's side that passes through a point.
int boundary_at(const std::vector<Polygon> &polygons, const Vector<2> &x)
{
  int boundary = inner_surface<2>;
  double least = 1e300;
  for (const Polygon &polygon : polygons)
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Vector<2> &a = polygon[k].place, b = polygon[(k + 1) % polygon.size()].place - a;
      const double share = std::clamp(b.dot(x - a) / b.squaredNorm(), 0., 1.);
      if (const double d = (a + share * b - x).norm(); d < least) {
        least = d;
        boundary = polygon[k].boundary;
      }
    }
  return boundary;
}

/// The corner or the crossing of two sides that is meant by a place: Boost.Geometry rounds places
/// to a grid of about 1e-8 of the figure, so that its decisions are robust.
Vector<2> exact(const std::vector<Polygon> &polygons, const Vector<2> &x, double tolerance)
{
  std::vector<std::pair<Vector<2>, Vector<2>>> lines; // a point, a unit direction
  for (const Polygon &polygon : polygons)
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Vector<2> &a = polygon[k].place, &b = polygon[(k + 1) % polygon.size()].place;
      if ((a - x).norm() < tolerance)
        return a;
      const Vector<2> along = (b - a).normalized(), off = x - a;
      const double at = std::clamp(along.dot(off), 0., (b - a).norm());
      if ((off - at * along).norm() < tolerance)
        lines.emplace_back(a, along);
    }
  const auto turn = [](const Vector<2> &u, const Vector<2> &v) {
    return u[0] * v[1] - u[1] * v[0];
  };
  for (std::size_t k = 1; k < lines.size(); ++k)
    if (const double sine = turn(lines[0].second, lines[k].second); std::abs(sine) > 1e-3)
      return lines[0].first +
             turn(lines[k].first - lines[0].first, lines[k].second) / sine * lines[0].second;
  return x;
}

/// Without sides that are shorter than the tolerance, which intersections of sides that nearly
/// touch leave.
Polygon from_boost(const BoostPolygon::ring_type &ring, const Frame &frame,
                   const std::vector<Polygon> &sources, double tolerance)
{
  std::vector<Vector<2>> corners;
  for (const BoostPoint &point : ring) {
    const Vector<2> x = exact(sources, frame.outward(point), tolerance);
    if (corners.empty() || (x - corners.back()).norm() > tolerance)
      corners.push_back(x);
  }
  while (corners.size() > 1 && (corners.front() - corners.back()).norm() <= tolerance)
    corners.pop_back();
  Polygon polygon;
  for (std::size_t k = 0; k < corners.size(); ++k)
    polygon.push_back(
        {corners[k], boundary_at(sources, (corners[k] + corners[(k + 1) % corners.size()]) / 2)});
  return polygon;
}
} // namespace

std::vector<Polygon> cut_polygons(const std::vector<Polygon> &polygons, std::size_t n,
                                  const std::vector<std::string> &keys, double tolerance)
{
  const Frame frame(polygons);
  const double least_area = std::pow(tolerance / frame.size(), 2);
  BoostPolygons left;
  for (std::size_t k = 0; k < n; ++k)
    if (core::signed_area(polygons[k]) > 0)
      left.push_back(frame.inward(polygons[k]));
  for (std::size_t k = 0; k < n; ++k)
    if (core::signed_area(polygons[k]) < 0) {
      BoostPolygon hole = frame.inward(polygons[k]);
      std::reverse(hole.outer().begin(), hole.outer().end());
      BoostPolygons next;
      bg::difference(left, hole, next);
      left = std::move(next);
    }
  const BoostPolygons whole = left;
  for (std::size_t k = n; k < polygons.size(); ++k) {
    BoostPolygons next;
    const BoostPolygon cut = frame.inward(polygons[k]);
    if (!bg::intersects(cut, whole))
      throw core::KeyedError(keys[k], fmt::format("{} lies outside the specimen", keys[k]),
                             "it takes nothing away", "move it, or remove it");
    bg::difference(left, cut, next);
    left = std::move(next);
  }
  std::vector<Polygon> result;
  for (const BoostPolygon &piece : left) {
    if (std::abs(bg::area(piece)) < least_area)
      continue;
    result.push_back(from_boost(piece.outer(), frame, polygons, tolerance));
    for (const auto &hole : piece.inners())
      if (std::abs(bg::area(hole)) > least_area)
        result.push_back(from_boost(hole, frame, polygons, tolerance));
  }
  if (result.empty())
    throw core::KeyedError("/specimen", "nothing of the specimen is left",
                           "cutouts and slots take all of it", "make them smaller");
  return result;
}
} // namespace ligament::program
