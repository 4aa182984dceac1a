#include "src/scene/body_shape.h"

#include "core/keyed_error.h"
#include "src/scene/body_file.h"
#include "src/scene/cut_polygons.h"

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
    refuse(error.what(), "check its radius and its unit; move the centre, or one end of the arc");
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

/// Likewise of a facet of a body from a file; those that STL knows have coordinates of six digits.
int side_of_box(const Specimen &specimen, const core::Solid<3>::Facet &facet)
{
  for (int side = 0; side < 6; ++side) {
    const int c = side / 2;
    const double place = side % 2 ? specimen.upper(c) : specimen.lower(c);
    if (std::all_of(facet.edges.begin(), facet.edges.end(), [&](const auto &edge) {
          return std::abs(specimen.body->vertices[edge[0]][c] - place) < 1e-6 * specimen.size[c];
        }))
      return side;
  }
  return inner_surface<3>;
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
  if (specimen.body)
    for (const std::string &name : specimen.body->names)
      visit(name);
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
  } else if (!specimen.file.empty()) {
    if (!specimen.body)
      specimen.body = std::make_shared<BodyFile>(read_body(specimen.file, dim));
    lower = Vector<3>::Constant(1e300);
    upper = -lower;
    const auto include = [&](const Vector<3> &x) {
      lower = lower.cwiseMin(x);
      upper = upper.cwiseMax(x);
    };
    for (const auto &polygon : specimen.body->polygons)
      for (const auto &corner : polygon)
        include({corner.place[0], corner.place[1], 0});
    for (const auto &facet : specimen.body->facets)
      for (const auto &[a, b] : facet.edges)
        include(specimen.body->vertices[a]);
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
  if (specimen.body && dim == 2)
    ; // polygons below
  else if (specimen.outline.empty())
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
  if (specimen.body && dim == 2)
    for (Polygon polygon : specimen.body->polygons) {
      for (auto &corner : polygon)
        corner.boundary = corner.boundary < 0
                              ? inner
                              : number_of(names, specimen.body->names[corner.boundary], inner);
      polygons.push_back(std::move(polygon));
      keys.push_back("/specimen/file");
    }
  const std::size_t n_outer = std::max<std::size_t>(1, polygons.size());
  for (const Loop &loop : loops) {
    polygons.push_back(checked_polygon(loop, side));
    keys.push_back(loop.key);
  }
  if (polygons.size() > n_outer)
    polygons = cut_polygons(polygons, n_outer, keys, 1e-7 * std::max(specimen.size[0], specimen.size[1]));
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
    if (specimen.body) {
      const std::vector<std::string> names = side_names_of(specimen, 3);
      auto facets = specimen.body->facets;
      for (auto &facet : facets)
        facet.boundary = facet.boundary < 0 ? side_of_box(specimen, facet)
                                            : number_of(names, specimen.body->names[facet.boundary],
                                                        inner_surface<3>);
      return std::make_shared<core::Solid<3>>(specimen.body->vertices, std::move(facets));
    }
    return std::make_shared<core::Solid<3>>(core::extrude(
        outline_of(specimen, 3, side, false), specimen.lower(2), specimen.upper(2), {4, 5}));
  }
}

template <int dim>
std::shared_ptr<const core::Solid<2>> mesh_outline_of(const Specimen &specimen, double side,
                                                      const core::BoxUnion<dim> &left_out)
{
  if (specimen.ball || (dim == 3 && specimen.body))
    throw KeyedError(specimen.ball ? "/specimen/ball" : "/specimen/file", "this body has no mesh",
                     "in 3D the far field fills boxes and prisms along z",
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
SurfaceFaces<dim>::SurfaceFaces(const Specimen &specimen)
    : specimen_(specimen),
      solid_(solid_of<dim>(specimen, std::max(specimen.size[0], specimen.size[1]) / 400))
{
}

template <int dim>
std::vector<core::FaceCorners<dim>> SurfaceFaces<dim>::of(int boundary) const
{
  if (!solid_)
    return {core::side_corners<dim>(Vector<dim>(specimen_.lower().data()),
                                    Vector<dim>(specimen_.upper().data()), boundary)};
  std::vector<core::FaceCorners<dim>> faces;
  for (const auto &facet : solid_->facets()) {
    if (facet.boundary != boundary)
      continue;
    auto &face = faces.emplace_back();
    const auto place = [&](int vertex) { return solid_->vertices()[vertex]; };
    const auto &edges = facet.edges;
    // Edges follow each other round the outer loop, then round openings, to which a cut leads.
    for (std::size_t k = 0; k < edges.size();) {
      const int start = edges[k][0];
      if (k > 0)
        face.push_back(place(edges[0][0]));
      const bool is_opening = k > 0;
      do
        face.push_back(place(edges[k][0]));
      while (edges[k++][1] != start && k < edges.size());
      if (is_opening)
        face.push_back(place(start));
    }
    if (dim == 2)
      face.push_back(place(edges.back()[1]));
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
template class SurfaceFaces<2>;
template class SurfaceFaces<3>;
template std::shared_ptr<const core::Solid<2>> solid_of(const Specimen &, double);
template std::shared_ptr<const core::Solid<3>> solid_of(const Specimen &, double);
} // namespace ligament::program
