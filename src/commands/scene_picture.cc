#include "src/commands/scene_picture.h"

#include "src/commands/gauge_marks.h"
#include "src/drawing/field_view.h"
#include "src/output/format.h"
#include "src/scene/geometry.h"
#include "src/simulation/body_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
using Mark = LegendEntry::Mark;

constexpr Color motion_color = {20, 20, 20}, traction_color = {110, 40, 150},
                held_color = {90, 90, 90}, absorbing_color = {20, 110, 200},
                crack_color = {225, 25, 60}, inclusion_color = {150, 105, 165},
                tool_color = {70, 70, 90};

/// What one part of the body looks like.
struct Part
{
  ZoneNumber zone;
  const char *particles, *cells; // names; null: there are none
  Color color;
};
constexpr Part parts[] = {
    {ZoneNumber::discrete, "discrete elements alone", nullptr, {96, 139, 184}},
    {ZoneNumber::overlap, "overlap", "overlap", {232, 170, 84}},
    {ZoneNumber::pad, "overlap: particles that move with the mesh", nullptr, {186, 104, 56}},
    {ZoneNumber::transition, nullptr, "transition", {170, 208, 188}},
    {ZoneNumber::far, nullptr, "finite elements alone", {224, 228, 234}}};

/// The particles that fulfil the condition.
template <typename Condition>
Scatter particles_where(const ParticleFields &all, Condition &&condition)
{
  const Field *radius = find_field(all.fields, "radius");
  Scatter scatter;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (condition(i)) {
      scatter.positions.insert(scatter.positions.end(), &all.reference[3 * i],
                               &all.reference[3 * i] + 3);
      scatter.radii.push_back(radius->values[i]);
    }
  return scatter;
}

/// The outside of the cells of one zone.
Quads cells_of(const CellFields &all, ZoneNumber zone)
{
  BodyState state;
  state.cells.dimension = all.dimension;
  state.cells.reference = all.reference;
  const Field *zones = find_field(all.cell_fields, "zone");
  const int n = all.nodes_per_cell();
  for (std::size_t c = 0; c < all.n_cells(); ++c)
    if (zones->values[c] == double(zone))
      state.cells.connectivity.insert(state.cells.connectivity.end(), &all.connectivity[n * c],
                                      &all.connectivity[n * c] + n);
  FieldView view;
  view.magnify = 0;
  const Picture picture = picture_of(state, all.dimension, view);
  Quads quads = picture.quads.empty() ? Quads() : picture.quads[0];
  quads.values.clear();
  quads.edge_color = {70, 70, 70};
  return quads;
}

void add_parts(const BodyState &state, Picture &picture)
{
  const Field *zones = find_field(state.particles.fields, "zone");
  const Field *materials = find_field(state.particles.fields, "material");
  for (const Part &part : parts) {
    auto particles = zones ? particles_where(state.particles,
                                             [&](std::size_t i) {
                                               return zones->values[i] == double(part.zone) &&
                                                      materials->values[i] == 0;
                                             })
                           : Scatter();
    auto cells = state.cells.n_cells() > 0 ? cells_of(state.cells, part.zone) : Quads();
    const bool has_particles = !particles.radii.empty(), has_cells = !cells.corners.empty();
    particles.color = cells.color = part.color;
    if (has_particles || has_cells)
      picture.legend.push_back({has_particles ? part.particles : part.cells, part.color});
    if (has_particles)
      picture.scatters.push_back(std::move(particles));
    if (has_cells)
      picture.quads.push_back(std::move(cells));
  }
  if (!materials)
    return;
  auto inclusions =
      particles_where(state.particles, [&](std::size_t i) { return materials->values[i] != 0; });
  inclusions.color = inclusion_color;
  if (inclusions.radii.empty())
    return;
  picture.legend.push_back({"inclusions", inclusion_color});
  picture.scatters.push_back(std::move(inclusions));
}

/// A side of the specimen's box.
template <int dim>
struct Side
{
  Vector<dim> lower, upper; // m, of the specimen
  int axis;
  bool is_upper;

  double size() const { return (upper - lower).maxCoeff(); }
  /// The point at these shares of the tangential edges, `outside` m off the side.
  std::array<double, 3> place(const std::array<double, 2> &share, double outside) const
  {
    std::array<double, 3> point = {};
    int tangent = 0;
    for (int c = 0; c < dim; ++c)
      point[c] = c == axis ? (is_upper ? upper[c] + outside : lower[c] - outside)
                           : lower[c] + share[tangent++] * (upper[c] - lower[c]);
    return point;
  }
  /// Points spread over the side, about `density` along the specimen's longest edge, at least three
  /// along each.
  std::vector<std::array<double, 3>> places(int density, double outside = 0) const
  {
    std::array<int, 2> n = {1, 1};
    int tangent = 0;
    for (int c = 0; c < dim; ++c)
      if (c != axis)
        n[tangent++] = std::max(3, int(std::lround(density * (upper[c] - lower[c]) / size())));
    std::vector<std::array<double, 3>> all;
    for (int a = 0; a < n[0]; ++a)
      for (int b = 0; b < n[1]; ++b)
        all.push_back(place({(a + 0.5) / n[0], (b + 0.5) / n[1]}, outside));
    return all;
  }
};

void append(Segments &segments, const std::array<double, 3> &a, const std::array<double, 3> &b)
{
  for (const auto *end : {&a, &b})
    for (const double x : *end)
      segments.points.push_back(x);
}

/// The outline of the side, `inside` m within the specimen.
template <int dim>
Segments outline(const Side<dim> &side, double inside, Color color, double width, bool dashed)
{
  Segments lines;
  lines.color = color;
  lines.width = width;
  lines.dashed = dashed;
  if (dim == 2)
    append(lines, side.place({0, 0}, -inside), side.place({1, 0}, -inside));
  else
    for (int k = 0; k < 4; ++k) {
      static constexpr std::array<double, 2> ring[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
      append(lines, side.place(ring[k], -inside), side.place(ring[(k + 1) % 4], -inside));
    }
  return lines;
}

/// Those of the places that the load acts on; the middle of its part where none is.
template <int dim>
std::vector<std::array<double, 3>> loaded_places(const LoadParameters &load, const Side<dim> &side,
                                                 int density)
{
  auto places = side.places(density);
  const auto part = part_of<dim>(load);
  places.erase(std::remove_if(places.begin(), places.end(),
                              [&](const auto &place) {
                                return !part.holds(Vector<dim>(place.data()), 1e-9 * side.size());
                              }),
               places.end());
  if (!places.empty())
    return places;
  std::array<double, 3> middle = {};
  const auto piece =
      part.clip(core::side_corners<dim>(side.lower, side.upper, 2 * side.axis + side.is_upper));
  for (int c = 0; c < dim && !piece.empty(); ++c)
    middle[c] = core::face_centroid<dim>(piece)[c];
  for (int c = 0; c < dim && piece.empty(); ++c) // a point
    middle[c] = c == side.axis ? (side.is_upper ? side.upper : side.lower)[c]
                : load.from    ? *load.from
                               : std::max(load.within.lower[c], side.lower[c]);
  return {middle};
}

/// Short slanted lines on the outer side of a held side.
template <int dim>
Segments hatching(const LoadParameters &load, const Side<dim> &side)
{
  Segments lines;
  if (part_of<dim>(load).is_whole())
    lines = outline(side, 0, held_color, 2, false);
  lines.color = held_color;
  lines.width = 2;
  const double depth = 0.02 * side.size();
  for (const auto &place : loaded_places(load, side, 40)) {
    auto outer = place;
    outer[side.axis] += side.is_upper ? depth : -depth;
    outer[side.axis == 0 ? 1 : 0] -= depth;
    append(lines, place, outer);
  }
  return lines;
}

std::string component_text(const PartialPoint &value, const std::string &unit, bool zero)
{
  std::string text;
  for (int c = 0; c < 3; ++c)
    if (value[c] && (*value[c] == 0) == zero) {
      const Prefix prefix = unit_prefix(std::abs(*value[c]), unit);
      text += fmt::format("{}{}", text.empty() ? " " : ", ", "xyz"[c]);
      if (!zero)
        text += fmt::format(" {:.3g} {}{}", *value[c] / prefix.factor, prefix.symbol, unit);
    }
  return text;
}

template <int dim>
void add_load(const LoadParameters &load, const CoupledBody<dim> &body, Picture &picture)
{
  const Side<dim> side{body.lower, body.upper, load.boundary / 2, load.boundary % 2 == 1};
  const std::string &name = side_names[load.boundary];
  const bool is_traction = load.kind == LoadKind::traction || load.kind == LoadKind::force;
  const std::string unit = load.kind == LoadKind::velocity ? "m/s"
                           : load.kind == LoadKind::force  ? "N"
                           : is_traction                   ? "Pa"
                                                           : "m";
  const Color color = is_traction ? traction_color : motion_color;

  std::array<double, 3> direction = {};
  for (int c = 0; c < dim; ++c)
    direction[c] = load.value[c].value_or(0);
  const double outward = direction[side.axis] * (side.is_upper ? 1 : -1);
  if (direction != std::array<double, 3>{}) {
    for (const auto &place : loaded_places(load, side, dim == 2 ? 12 : 6))
      picture.arrows.push_back({place, direction, outward < 0, color});
    picture.legend.push_back(
        {name + ": " + word_of(load.kind) + component_text(load.value, unit, false), color,
         Mark::arrow});
  }
  if (const std::string held = component_text(load.value, "", true); !held.empty() && !is_traction)
  {
    picture.segments.push_back(hatching(load, side));
    picture.legend.push_back({name + ": held in" + held, held_color, Mark::line});
  }
  if (load.absorbing) {
    picture.segments.push_back(outline(side, 0, absorbing_color, 6, false));
    if (load.absorbing_layer > 0)
      picture.segments.push_back(outline(side, load.absorbing_layer, absorbing_color, 2, true));
    picture.legend.push_back({name + ": absorbing", absorbing_color, Mark::line});
  }
}

void add_cracks(const Scene &scene, Picture &picture)
{
  Segments lines;
  lines.color = crack_color;
  lines.width = 3;
  for (const auto &crack : scene.specimen.cracks)
    for (std::size_t k = 0; k + (scene.dimension == 2 ? 1 : 0) < crack.points.size(); ++k)
      append(lines, crack.points[k], crack.points[(k + 1) % crack.points.size()]);
  if (lines.points.empty())
    return;
  picture.segments.push_back(std::move(lines));
  picture.legend.push_back({"initial crack", crack_color, Mark::line});
}

template <int dim>
void add_tools(const CoupledBody<dim> &body, Picture &picture)
{
  const auto outlines = tool_outlines(body);
  for (std::size_t k = 0; k < outlines.size(); ++k) {
    Segments lines;
    lines.color = tool_color;
    lines.width = 2.5;
    lines.points = outlines[k].points;
    picture.segments.push_back(std::move(lines));
    picture.legend.push_back({"tool " + body.tools->name(int(k)), tool_color, Mark::line});
    const Vector<dim> way = body.tools->drive(int(k)), place = body.tools->place(int(k));
    if (way.norm() == 0)
      continue;
    std::array<double, 3> at = {}, along = {};
    for (int c = 0; c < dim; ++c) {
      at[c] = std::max(body.lower[c], std::min(place[c], body.upper[c]));
      along[c] = way[c];
    }
    picture.arrows.push_back({at, along, true, tool_color});
  }
}

/// The edges of the packing, cut to the specimen.
template <int dim>
void add_zone_boxes(const Scene &scene, const CoupledBody<dim> &body, Picture &picture)
{
  if (scene.zone.extent != DiscreteZone::Extent::box)
    return;
  Segments lines;
  lines.color = held_color;
  lines.width = 1.5;
  lines.dashed = true;
  for (const auto &part : zone_shape<dim>(scene).boxes) {
    const auto at = [&](int corner) {
      std::array<double, 3> point = {};
      for (int c = 0; c < dim; ++c)
        point[c] = corner >> c & 1 ? std::min(part.upper[c], body.upper[c])
                                   : std::max(part.lower[c], body.lower[c]);
      return point;
    };
    for (int corner = 0; corner < 1 << dim; ++corner)
      for (int axis = 0; axis < dim; ++axis)
        if (!(corner >> axis & 1))
          append(lines, at(corner), at(corner | 1 << axis));
  }
  picture.segments.push_back(std::move(lines));
  picture.legend.push_back({"discrete zone", held_color, Mark::dashes});
}
} // namespace

template <int dim>
Picture scene_picture(const CoupledBody<dim> &body, const Scene &scene)
{
  BodyState state;
  state.particles = particle_fields(body);
  state.cells = cell_fields(body);
  StateFields<dim>().complete(body, state);
  Picture picture;
  picture.dimension = dim;
  picture.title = scene.title;
  add_parts(state, picture);
  add_zone_boxes(scene, body, picture);
  add_cracks(scene, picture);
  for (const auto &load : scene.loads)
    add_load(load, body, picture);
  add_gauges(scene, picture);
  add_tools(body, picture);
  std::string size;
  if (state.particles.size() > 0)
    size = grouped(std::int64_t(state.particles.size())) + " particles";
  if (state.cells.n_cells() > 0)
    size += (size.empty() ? "" : ", ") + grouped(std::int64_t(state.cells.n_cells())) + " cells";
  picture.notes.push_back(size);
  return picture;
}

template Picture scene_picture(const CoupledBody<2> &, const Scene &);
template Picture scene_picture(const CoupledBody<3> &, const Scene &);
} // namespace ligament::program
