#include "src/commands/scene_picture.h"

#include "src/commands/gauge_marks.h"
#include "src/drawing/field_view.h"
#include "src/output/format.h"
#include "src/scene/body_shape.h"
#include "src/scene/geometry.h"
#include "src/simulation/body_fields.h"

#include <Eigen/Geometry>
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

/// A point of the surface, and the way out of the body there.
struct Place
{
  std::array<double, 3> point, outward;
};

template <int dim>
std::array<double, 3> to_point(const Vector<dim> &x)
{
  std::array<double, 3> point = {};
  std::copy(x.data(), x.data() + dim, point.begin());
  return point;
}

/// Unit, out of the body.
template <int dim>
Vector<dim> outward(const core::FaceCorners<dim> &face, int boundary)
{
  if (boundary < 2 * dim)
    return (boundary % 2 ? 1 : -1) * Vector<dim>::Unit(boundary / 2);
  if constexpr (dim == 2) {
    const Vector<2> along = face[1] - face[0];
    return Vector<2>(along[1], -along[0]).normalized();
  } else
    return (face[1] - face[0]).cross(face[2] - face[0]).normalized();
}

/// Points spread over what the load acts on, about `density` along the specimen's longest edge; at
/// least one.
template <int dim>
std::vector<Place> loaded_places(const Scene &scene, const LoadParameters &load, int density)
{
  const auto part = part_of<dim>(load);
  const auto &size = scene.specimen.size;
  const double step = *std::max_element(size.begin(), size.begin() + dim) / density;
  std::vector<Place> places, middles;
  double rest = step / 2; // of a way along the faces, until the next place
  for (const auto &face : faces_of<dim>(scene.specimen, load.boundary)) {
    auto piece = part.clip(face);
    if (piece.empty() && core::face_area<dim>(face) > 0 && load.kind == LoadKind::force)
      piece = {Vector<dim>(core::face_centroid<dim>(face))};
    if (piece.empty())
      continue;
    const auto out = to_point<dim>(outward<dim>(face, load.boundary));
    if constexpr (dim == 2) {
      const double length = piece.size() > 1 ? (piece[1] - piece[0]).norm() : 0;
      middles.push_back({to_point<dim>((piece.front() + piece.back()) / 2), out});
      for (; rest < length; rest += step)
        places.push_back({to_point<dim>(piece[0] + rest / length * (piece[1] - piece[0])), out});
      rest -= length;
    } else {
      // A grid over the box around the face, of which the points on it count.
      middles.push_back({to_point<dim>(core::face_centroid<dim>(piece)), out});
      const Vector<dim> n(out.data());
      Vector<dim> lower = piece[0], upper = piece[0];
      for (const auto &x : piece) {
        lower = lower.cwiseMin(x);
        upper = upper.cwiseMax(x);
      }
      Eigen::Matrix<int, dim, 1> count;
      for (int c = 0; c < dim; ++c)
        count[c] = std::max(std::abs(n[c]) > 0.999 ? 1 : 3, int((upper - lower)[c] / step));
      for (int k = 0; k < count.prod(); ++k) {
        Vector<dim> x;
        for (int c = 0, left = k; c < dim; left /= count[c++])
          x[c] = lower[c] + (left % count[c] + 0.5) / count[c] * (upper - lower)[c];
        if (std::abs(n.dot(x - piece[0])) < 1e-9 * step && part.holds(x, 1e-9 * step))
          places.push_back({to_point<dim>(x), out});
      }
    }
  }
  if (places.empty() && !middles.empty())
    places.push_back(middles[middles.size() / 2]);
  return places;
}

void append(Segments &segments, const std::array<double, 3> &a, const std::array<double, 3> &b)
{
  for (const auto *end : {&a, &b})
    for (const double x : *end)
      segments.points.push_back(x);
}

/// The edges of the loaded faces, `inside` m within the specimen.
template <int dim>
Segments outline(const Scene &scene, const LoadParameters &load, double inside, Color color,
                 double width, bool dashed)
{
  Segments lines;
  lines.color = color;
  lines.width = width;
  lines.dashed = dashed;
  for (const auto &face : faces_of<dim>(scene.specimen, load.boundary)) {
    const Vector<dim> shift = -inside * outward<dim>(face, load.boundary);
    const auto piece = part_of<dim>(load).clip(face);
    for (std::size_t k = 0; k + (dim == 2 ? 1 : 0) < piece.size(); ++k)
      append(lines, to_point<dim>(piece[k] + shift),
             to_point<dim>(piece[(k + 1) % piece.size()] + shift));
  }
  return lines;
}

/// Short slanted lines on the outer side of a held side.
template <int dim>
Segments hatching(const Scene &scene, const LoadParameters &load)
{
  Segments lines = outline<dim>(scene, load, 0, held_color, 2, false);
  const auto &size = scene.specimen.size;
  const double depth = 0.02 * *std::max_element(size.begin(), size.begin() + dim);
  for (const auto &[point, out] : loaded_places<dim>(scene, load, 40)) {
    auto outer = point;
    for (int c = 0; c < dim; ++c)
      outer[c] += depth * out[c];
    // Slanted: along the side, towards its lower end.
    const int along = std::abs(out[0]) > std::abs(out[1]) ? 1 : 0;
    outer[along] -= depth;
    append(lines, point, outer);
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
void add_load(const Scene &scene, const LoadParameters &load, Picture &picture)
{
  const std::string &name = load.side;
  const bool is_traction = load.kind == LoadKind::traction || load.kind == LoadKind::force ||
                           load.kind == LoadKind::pressure;
  const std::string unit = load.kind == LoadKind::velocity ? "m/s"
                           : load.kind == LoadKind::force  ? "N"
                           : is_traction                   ? "Pa"
                                                           : "m";
  const Color color = is_traction ? traction_color : motion_color;

  std::array<double, 3> direction = {};
  for (int c = 0; c < dim; ++c)
    direction[c] = load.value[c].value_or(0);
  if (direction != std::array<double, 3>{}) {
    for (const auto &[point, out] : loaded_places<dim>(scene, load, dim == 2 ? 12 : 6)) {
      const double outward = direction[0] * out[0] + direction[1] * out[1] + direction[2] * out[2];
      picture.arrows.push_back({point, direction, outward < 0, color});
    }
    picture.legend.push_back(
        {name + ": " + word_of(load.kind) + component_text(load.value, unit, false), color,
         Mark::arrow});
  }
  if (load.pressure && *load.pressure != 0) {
    const Prefix prefix = unit_prefix(std::abs(*load.pressure), "Pa");
    for (const auto &[point, out] : loaded_places<dim>(scene, load, dim == 2 ? 12 : 6)) {
      for (int c = 0; c < dim; ++c)
        direction[c] = -*load.pressure * out[c];
      picture.arrows.push_back({point, direction, *load.pressure > 0, color});
    }
    picture.legend.push_back({fmt::format("{}: pressure {:.3g} {}Pa", name,
                                          *load.pressure / prefix.factor, prefix.symbol),
                              color, Mark::arrow});
  }
  if (const std::string held = component_text(load.value, "", true); !held.empty() && !is_traction)
  {
    picture.segments.push_back(hatching<dim>(scene, load));
    picture.legend.push_back({name + ": held in" + held, held_color, Mark::line});
  }
  if (load.absorbing) {
    picture.segments.push_back(outline<dim>(scene, load, 0, absorbing_color, 6, false));
    if (load.absorbing_layer > 0)
      picture.segments.push_back(
          outline<dim>(scene, load, load.absorbing_layer, absorbing_color, 2, true));
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
    add_load<dim>(scene, load, picture);
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
