#include "src/scene/body_shape.h"

#include "core/keyed_error.h"
#include "src/scene/surface_file.h"

#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
using core::KeyedError;
using core::Outline;
using core::Polygon;

Vector<2> plane(const Point &p)
{
  return {p[0], p[1]};
}

std::string text(const Vector<2> &x)
{
  return fmt::format("({:.6g}, {:.6g}) m", x[0], x[1]);
}

/// An outline, and the key that it came from.
struct Loop
{
  Outline outline;
  std::string key;
};

int number_of(const std::vector<std::string> &names, const std::string &name, int inner)
{
  if (name.empty())
    return inner;
  return int(std::find(names.begin(), names.end(), name) - names.begin());
}

Outline outline_from(const std::vector<OutlineCorner> &corners, const std::string &rim,
                     const std::vector<std::string> &names, int inner)
{
  Outline outline;
  for (const OutlineCorner &corner : corners) {
    core::OutlineEdge edge;
    edge.to = plane(corner.at);
    if (corner.centre[0] && corner.centre[1])
      edge.centre = Vector<2>(*corner.centre[0], *corner.centre[1]);
    edge.clockwise = corner.clockwise;
    edge.boundary = number_of(names, corner.side.empty() ? rim : corner.side, inner);
    outline.push_back(edge);
  }
  return outline;
}

Outline outline_from(const Slot &slot, int boundary)
{
  const Vector<2> from = plane(slot.from), to = plane(slot.to), along = (to - from).normalized(),
                  across(-along[1], along[0]);
  const double half = slot.width / 2;
  const double tip = slot.tip == SlotTip::flat    ? 0
                     : slot.tip == SlotTip::round ? half
                                                  : half / std::tan(slot.tip_angle / 2);
  const Vector<2> mouth = from - slot.width * along, shoulder = to - tip * along;
  Outline outline = {{mouth + half * across, {}, false, boundary},
                     {mouth - half * across, {}, false, boundary},
                     {shoulder - half * across, {}, false, boundary}};
  if (slot.tip == SlotTip::round)
    outline.push_back({shoulder + half * across, shoulder, false, boundary});
  else if (slot.tip == SlotTip::v) {
    outline.push_back({to, {}, false, boundary});
    outline.push_back({shoulder + half * across, {}, false, boundary});
  } else
    outline.push_back({shoulder + half * across, {}, false, boundary});
  return outline;
}

/// Smallest box around an outline, arcs included.
std::pair<Vector<2>, Vector<2>> box_around(const Outline &outline)
{
  Vector<2> lower = outline[0].to, upper = lower;
  const auto include = [&](const Vector<2> &x) {
    lower = lower.cwiseMin(x);
    upper = upper.cwiseMax(x);
  };
  for (std::size_t k = 0; k < outline.size(); ++k) {
    include(outline[k].to);
    if (!outline[k].centre)
      continue;
    const Vector<2> &c = *outline[k].centre;
    Vector<2> a = outline[k == 0 ? outline.size() - 1 : k - 1].to - c, b = outline[k].to - c;
    const double radius = a.norm();
    if (outline[k].clockwise)
      std::swap(a, b);
    const double from = std::atan2(a[1], a[0]);
    double way = std::atan2(b[1], b[0]) - from;
    if (way <= 0 || outline.size() == 1)
      way += 2 * M_PI;
    for (int quarter = -4; quarter <= 8; ++quarter)
      if (const double at = quarter * M_PI / 2; at > from && at < from + way)
        include(c + radius * Vector<2>(quarter % 4 == 0             ? 1
                                       : std::abs(quarter) % 4 == 2 ? -1
                                                                    : 0,
                                       (quarter % 4 + 4) % 4 == 1   ? 1
                                       : (quarter % 4 + 4) % 4 == 3 ? -1
                                                                    : 0));
  }
  return {lower, upper};
}

Polygon checked_polygon(const Loop &loop, double side)
{
  const auto refuse = [&](const std::string &what, const std::string &remedy) {
    throw KeyedError(loop.key, fmt::format("{} is no outline", loop.key), what, remedy);
  };
  const bool is_circle = loop.outline.size() == 1 && loop.outline[0].centre;
  const bool has_arc = std::any_of(loop.outline.begin(), loop.outline.end(),
                                   [](const auto &edge) { return edge.centre.has_value(); });
  if (!is_circle && loop.outline.size() < (has_arc ? 2 : 3))
    refuse(fmt::format("it has {} corners", loop.outline.size()),
           "give three corners or more, two with an arc, or one with the centre of a circle");
  for (std::size_t k = 0; k < loop.outline.size(); ++k) {
    const auto &before = loop.outline[k == 0 ? loop.outline.size() - 1 : k - 1];
    if (!is_circle && before.to == loop.outline[k].to)
      refuse(fmt::format("the corner {} comes twice", text(before.to)),
             "remove one of the two; the outline closes by itself");
  }
  Polygon polygon;
  try {
    polygon = core::polygon(loop.outline, side);
  } catch (const core::InputError &error) {
    refuse(error.what(), "move the centre, or one end of the arc");
  }
  if (const auto place = core::crossing({polygon}))
    refuse(fmt::format("it crosses or touches itself near {}", text(*place)),
           "give its corners in turn; for two bodies that touch at a corner, move them apart");
  if (core::signed_area(polygon) > 0)
    return polygon;
  Polygon turned; // a corner has the boundary of the side behind it
  for (std::size_t k = 0, n = polygon.size(); k < n; ++k)
    turned.push_back({polygon[n - 1 - k].place, polygon[(2 * n - 2 - k) % n].boundary});
  return turned;
}

namespace bg = boost::geometry;
using BoostPoint = bg::model::d2::point_xy<double>;
using BoostPolygon = bg::model::polygon<BoostPoint, false, false>; // counter-clockwise, open
using BoostPolygons = bg::model::multi_polygon<BoostPolygon>;

BoostPolygon to_boost(const Polygon &polygon)
{
  BoostPolygon result;
  for (const auto &corner : polygon)
    result.outer().emplace_back(corner.place[0], corner.place[1]);
  return result;
}

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
Polygon from_boost(const BoostPolygon::ring_type &ring, const std::vector<Polygon> &sources,
                   double tolerance)
{
  std::vector<Vector<2>> corners;
  for (const BoostPoint &point : ring) {
    const Vector<2> x = exact(sources, Vector<2>(point.x(), point.y()), tolerance);
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

/// The first polygon without the others.
std::vector<Polygon> without(const std::vector<Polygon> &polygons,
                             const std::vector<std::string> &keys, double tolerance)
{
  BoostPolygons left = {to_boost(polygons[0])};
  for (std::size_t k = 1; k < polygons.size(); ++k) {
    BoostPolygons next;
    const BoostPolygon cut = to_boost(polygons[k]);
    if (!bg::intersects(cut, to_boost(polygons[0])))
      throw KeyedError(keys[k], fmt::format("{} lies outside the specimen", keys[k]),
                       "it takes nothing away", "move it, or remove it");
    bg::difference(left, cut, next);
    left = std::move(next);
  }
  std::vector<Polygon> result;
  for (const BoostPolygon &piece : left) {
    if (std::abs(bg::area(piece)) < tolerance * tolerance)
      continue;
    result.push_back(from_boost(piece.outer(), polygons, tolerance));
    for (const auto &hole : piece.inners())
      if (std::abs(bg::area(hole)) > tolerance * tolerance)
        result.push_back(from_boost(hole, polygons, tolerance));
  }
  if (result.empty())
    throw KeyedError("/specimen", "nothing of the specimen is left",
                     "cutouts and slots take all of it", "make them smaller");
  return result;
}

/// Sides without a name on the box belong to its sides.
void name_sides_of_box(const Specimen &specimen, std::vector<Polygon> &polygons, int inner)
{
  for (Polygon &polygon : polygons)
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      if (polygon[k].boundary != inner)
        continue;
      const Vector<2> &a = polygon[k].place, &b = polygon[(k + 1) % polygon.size()].place;
      for (int c = 0; c < 2; ++c)
        for (int upper = 0; upper < 2; ++upper) {
          const double side = upper ? specimen.upper(c) : specimen.lower(c);
          const double tolerance = 1e-9 * specimen.size[c];
          if (std::abs(a[c] - side) < tolerance && std::abs(b[c] - side) < tolerance)
            polygon[k].boundary = 2 * c + upper;
        }
    }
}

template <typename Visit>
void for_each_name(const Specimen &specimen, Visit &&visit)
{
  for (std::size_t k = 0; k < specimen.outline.size(); ++k)
    visit(specimen.outline[k].side);
  for (const Cutout &cutout : specimen.cutouts) {
    visit(cutout.side);
    for (const OutlineCorner &corner : cutout.outline)
      visit(corner.side);
  }
  for (const Slot &slot : specimen.slots)
    visit(slot.side);
}
} // namespace

std::vector<std::string> side_names_of(const Specimen &specimen, int dim)
{
  std::vector<std::string> names(box_sides.begin(), box_sides.begin() + 2 * dim);
  names.emplace_back();
  for_each_name(specimen, [&](const std::string &name) {
    if (std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(name);
  });
  return names;
}

void enclose_body(Specimen &specimen, int dim)
{
  if (!specimen.has_own_box())
    return;
  Vector<3> lower, upper;
  if (specimen.ball) {
    upper = Vector<3>::Constant(specimen.ball->radius);
    lower = -upper;
  } else if (!specimen.surface_file.empty()) {
    const core::Solid<3> solid = read_surface(specimen.surface_file);
    lower = solid.lower();
    upper = solid.upper();
  } else {
    const auto [least, most] = box_around(outline_from(specimen.outline, "", {}, 0));
    lower << least, -specimen.thickness / 2;
    upper << most, specimen.thickness / 2;
  }
  for (int c = 0; c < dim; ++c) {
    if (!(upper[c] > lower[c]))
      throw KeyedError("/specimen/outline", "the outline has no extent",
                       "its corners lie on a line", "give corners around an area");
    specimen.centre[c] = (lower[c] + upper[c]) / 2;
    specimen.size[c] = upper[c] - lower[c];
  }
}

std::vector<Polygon> outline_of(const Specimen &specimen, int dim, double side, bool voids)
{
  const int inner = 2 * dim;
  const std::vector<std::string> names = side_names_of(specimen, dim);
  std::vector<Loop> loops;
  if (specimen.outline.empty())
    loops.push_back(
        {core::rectangle({specimen.lower(0), specimen.lower(1)},
                         {specimen.upper(0), specimen.upper(1)}, {inner, inner, inner, inner}),
         "/specimen/size"});
  else
    loops.push_back({outline_from(specimen.outline, "", names, inner), "/specimen/outline"});
  const auto key = [](const char *list, std::size_t k) {
    return fmt::format("/specimen/{}/{}", list, k);
  };
  for (std::size_t k = 0; k < specimen.cutouts.size(); ++k)
    loops.push_back(
        {outline_from(specimen.cutouts[k].outline, specimen.cutouts[k].side, names, inner),
         key("cutouts", k)});
  for (std::size_t k = 0; k < specimen.slots.size(); ++k)
    loops.push_back(
        {outline_from(specimen.slots[k], number_of(names, specimen.slots[k].side, inner)),
         key("slots", k)});
  for (std::size_t k = 0; voids && k < specimen.holes.size(); ++k)
    loops.push_back({core::circle(plane(specimen.holes[k].centre), specimen.holes[k].radius, inner),
                     key("holes", k)});
  for (std::size_t k = 0; voids && k < specimen.notches.size(); ++k) {
    const Notch &notch = specimen.notches[k];
    loops.push_back(
        {core::rectangle(plane(notch.lower), plane(notch.upper), {inner, inner, inner, inner}),
         key("notches", k)});
  }
  std::vector<Polygon> polygons;
  std::vector<std::string> keys;
  for (const Loop &loop : loops) {
    polygons.push_back(checked_polygon(loop, side));
    keys.push_back(loop.key);
  }
  if (polygons.size() > 1)
    polygons = without(polygons, keys, 1e-7 * std::max(specimen.size[0], specimen.size[1]));
  name_sides_of_box(specimen, polygons, inner);
  return polygons;
}

template <int dim>
std::shared_ptr<const core::Solid<dim>> solid_of(const Specimen &specimen, double side)
{
  if (specimen.is_plain())
    return {};
  if constexpr (dim == 2)
    return std::make_shared<core::Solid<2>>(core::make_solid(outline_of(specimen, 2, side, true)));
  else {
    if (specimen.ball)
      return std::make_shared<core::Solid<3>>(
          core::make_ball(Vector<3>::Zero(), specimen.ball->radius, 2 * side, inner_surface<3>));
    if (!specimen.surface_file.empty())
      return std::make_shared<core::Solid<3>>(read_surface(specimen.surface_file));
    return std::make_shared<core::Solid<3>>(core::extrude(
        outline_of(specimen, 3, side, false), specimen.lower(2), specimen.upper(2), {4, 5}));
  }
}

template <int dim>
std::shared_ptr<const core::Solid<2>> mesh_outline_of(const Specimen &specimen, double side,
                                                      const core::BoxUnion<dim> &left_out)
{
  if (specimen.ball || !specimen.surface_file.empty())
    throw KeyedError(specimen.ball ? "/specimen/ball" : "/specimen/surface_file",
                     "this body has no mesh", "in 3D the far field fills boxes and prisms along z",
                     "make it discrete: \"far_field\": \"none\"");
  Specimen meshed = specimen;
  if (dim == 3) { // voids in 3D are inside the zone
    meshed.holes.clear();
    meshed.notches.clear();
  }
  const auto is_left_out = [&](const Point &lower, const Point &upper) {
    return left_out.covers(Vector<dim>(lower.data()), Vector<dim>(upper.data()), 0);
  };
  const auto drop = [](auto &list, const auto &condition) {
    list.erase(std::remove_if(list.begin(), list.end(), condition), list.end());
  };
  drop(meshed.holes, [&](const Hole &hole) {
    const auto &[c, r] = hole;
    return is_left_out({c[0] - r, c[1] - r, 0}, {c[0] + r, c[1] + r, 0});
  });
  drop(meshed.notches, [&](const Notch &notch) {
    Point lower = notch.lower, upper = notch.upper;
    for (int c = 0; c < dim; ++c) {
      lower[c] = std::max(lower[c], specimen.lower(c));
      upper[c] = std::min(upper[c], specimen.upper(c));
    }
    return is_left_out(lower, upper);
  });
  if (meshed.is_plain() && meshed.holes.empty() && meshed.notches.empty())
    return {};
  return std::make_shared<core::Solid<2>>(
      core::make_solid(outline_of(meshed, dim, side, dim == 2)));
}

template <int dim>
std::vector<core::FaceCorners<dim>> faces_of(const Specimen &specimen, int boundary)
{
  const double size = std::max(specimen.size[0], specimen.size[1]);
  const auto solid = solid_of<dim>(specimen, size / 400);
  if (!solid)
    return {core::side_corners<dim>(Vector<dim>(specimen.lower().data()),
                                    Vector<dim>(specimen.upper().data()), boundary)};
  std::vector<core::FaceCorners<dim>> faces;
  for (const auto &facet : solid->facets()) {
    if (facet.boundary != boundary)
      continue;
    auto &face = faces.emplace_back();
    int next = facet.edges[0][0]; // edges follow each other round the outer loop
    for (const auto &[a, b] : facet.edges) {
      if (a != next && b != facet.edges[0][0])
        continue;
      face.push_back(solid->vertices()[a]);
      next = b;
    }
    if (dim == 2)
      face.push_back(solid->vertices()[next]);
  }
  return faces;
}

BodyTest::BodyTest(const Specimen &specimen, int dim) : specimen_(specimen), dim_(dim)
{
  const double size = std::max(specimen.size[0], specimen.size[1]), side = size / 1000;
  tolerance_ = 1e-5 * size;
  if (dim == 2)
    flat_ = solid_of<2>(specimen, side);
  else
    solid_ = solid_of<3>(specimen, side);
}

bool BodyTest::contains(const Point &p) const
{
  if (flat_)
    return flat_->distance(plane(p), tolerance_) > -tolerance_;
  if (solid_ && solid_->distance(Vector<3>(p.data()), tolerance_) <= -tolerance_)
    return false;
  for (const Hole &hole : specimen_.holes)
    if (dim_ == 2 && std::hypot(p[0] - hole.centre[0], p[1] - hole.centre[1]) < hole.radius)
      return false;
  for (const Notch &notch : specimen_.notches) {
    bool inside = true;
    for (int c = 0; c < dim_; ++c)
      inside = inside && p[c] > notch.lower[c] && p[c] < notch.upper[c];
    if (inside)
      return false;
  }
  return true;
}

template std::shared_ptr<const core::Solid<2>> mesh_outline_of<2>(const Specimen &, double,
                                                                  const core::BoxUnion<2> &);
template std::shared_ptr<const core::Solid<2>> mesh_outline_of<3>(const Specimen &, double,
                                                                  const core::BoxUnion<3> &);
template std::vector<core::FaceCorners<2>> faces_of<2>(const Specimen &, int);
template std::vector<core::FaceCorners<3>> faces_of<3>(const Specimen &, int);
template std::shared_ptr<const core::Solid<2>> solid_of(const Specimen &, double);
template std::shared_ptr<const core::Solid<3>> solid_of(const Specimen &, double);
} // namespace ligament::program
