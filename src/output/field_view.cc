#include "src/output/picture.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

namespace ligament::program
{
namespace
{
constexpr Color crack_color = {225, 25, 60}, zone_color = {90, 90, 90};

/// One number per item for the colour: a component, the length of a vector, von Mises of a tensor.
std::vector<double> coloring(const Field &field, int component)
{
  const int n = field.n_components();
  std::vector<double> values(field.values.size() / n);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double *v = &field.values[n * i];
    if (component >= 0 || n == 1)
      values[i] = v[std::clamp(component, 0, n - 1)];
    else if (n == 3)
      values[i] = std::hypot(v[0], v[1], v[2]);
    else {
      const double xy = v[0] - v[1], yz = v[1] - v[2], zx = v[2] - v[0];
      values[i] = std::sqrt(0.5 * (xy * xy + yz * yz + zx * zx) +
                            3 * (v[3] * v[3] + v[4] * v[4] + v[5] * v[5]));
    }
  }
  return values;
}

std::string label_of(const Field &field, int component)
{
  static constexpr const char *vector[] = {"x", "y", "z"};
  static constexpr const char *tensor[] = {"xx", "yy", "zz", "xy", "yz", "xz"};
  if (field.kind == Field::Kind::scalar)
    return field.name;
  if (component < 0)
    return field.kind == Field::Kind::tensor ? "von Mises " + field.name : field.name;
  return field.name + " " + (field.kind == Field::Kind::tensor ? tensor : vector)[component];
}

/// Mean over the cells around each node.
std::vector<double> to_nodes(const CellFields &cells, const std::vector<double> &cell_values)
{
  std::vector<double> sum(cells.n_nodes()), count(cells.n_nodes());
  const int n = cells.nodes_per_cell();
  for (std::size_t c = 0; c < cells.n_cells(); ++c)
    for (int k = 0; k < n; ++k) {
      const auto node = cells.connectivity[n * c + k];
      sum[node] += cell_values[c];
      count[node] += 1;
    }
  for (std::size_t i = 0; i < sum.size(); ++i)
    sum[i] /= std::max(count[i], 1.);
  return sum;
}

std::vector<double> moved(const std::vector<double> &reference, const Field *displacement,
                          double magnify)
{
  std::vector<double> points = reference;
  if (displacement)
    for (std::size_t i = 0; i < points.size(); ++i)
      points[i] += magnify * displacement->values[i];
  return points;
}

/// Displacements that show as 3 % of the size of the specimen.
double good_magnification(const ParticleFields &particles, const CellFields &cells)
{
  double lower[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, upper[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (const auto *points : {&particles.reference, &cells.reference})
    for (std::size_t i = 0; i < points->size(); ++i) {
      lower[i % 3] = std::min(lower[i % 3], (*points)[i]);
      upper[i % 3] = std::max(upper[i % 3], (*points)[i]);
    }
  double largest = 0;
  for (const auto *fields : {&particles.fields, &cells.node_fields})
    if (const Field *u = find_field(*fields, "displacement"))
      for (const double value : u->values)
        largest = std::max(largest, std::abs(value));
  const double size = std::hypot(upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]);
  return largest > 0 ? 0.03 * size / largest : 0;
}

/// True where the item at x has been cut away.
bool is_cut(const FieldView &view, const double *x)
{
  if (!view.cut)
    return false;
  const auto &c = *view.cut;
  return (x[0] - c[0]) * c[3] + (x[1] - c[1]) * c[4] + (x[2] - c[2]) * c[5] > 0;
}

/// 2D: the cells; 3D: the faces that belong to one cell only.
std::vector<std::int64_t> visible_faces(const CellFields &cells, const FieldView &view)
{
  if (cells.dimension == 2)
    return cells.connectivity;
  static constexpr int faces[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                      {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  std::map<std::array<std::int64_t, 4>, std::array<std::int64_t, 4>> single;
  for (std::size_t c = 0; c < cells.n_cells(); ++c) {
    const std::int64_t *nodes = &cells.connectivity[8 * c];
    double centre[3] = {};
    for (int k = 0; k < 8; ++k)
      for (int d = 0; d < 3; ++d)
        centre[d] += cells.reference[3 * nodes[k] + d] / 8;
    if (is_cut(view, centre))
      continue;
    for (const auto &face : faces) {
      const std::array<std::int64_t, 4> ring = {nodes[face[0]], nodes[face[1]], nodes[face[2]],
                                                nodes[face[3]]};
      auto key = ring;
      std::sort(key.begin(), key.end());
      if (!single.emplace(key, ring).second)
        single.erase(key);
    }
  }
  std::vector<std::int64_t> corners;
  for (const auto &entry : single)
    corners.insert(corners.end(), entry.second.begin(), entry.second.end());
  return corners;
}

Scatter visible_particles(const ParticleFields &particles, const FieldView &view, double magnify,
                          double radius)
{
  Scatter all;
  all.radius = radius;
  const Field *color = find_field(particles.fields, view.field);
  const auto values = color ? coloring(*color, view.component) : std::vector<double>();
  const auto positions =
      moved(particles.reference, find_field(particles.fields, "displacement"), magnify);
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (!is_cut(view, &particles.reference[3 * i])) {
      all.positions.insert(all.positions.end(), &positions[3 * i], &positions[3 * i] + 3);
      if (color)
        all.values.push_back(values[i]);
    }
  return all;
}

/// Broken faces between the moved particles: a line in 2D, a cross of the face's size in 3D.
Segments broken_faces(const ParticleFields &particles, const std::vector<BrokenBond> &bonds,
                      int dimension, const FieldView &view, double magnify)
{
  const Field *ids = find_field(particles.fields, "global_id");
  const Field *u = find_field(particles.fields, "displacement");
  std::unordered_map<std::int64_t, std::size_t> index;
  if (ids && u)
    for (std::size_t i = 0; i < particles.size(); ++i)
      index[std::int64_t(ids->values[i])] = i;
  Segments segments;
  segments.color = crack_color;
  segments.width = 2.5;
  for (const auto &bond : bonds) {
    if (is_cut(view, bond.centroid))
      continue;
    double centre[3];
    for (int c = 0; c < 3; ++c) {
      centre[c] = bond.centroid[c];
      for (const std::int64_t id : {bond.i, bond.j})
        if (const auto particle = index.find(id); particle != index.end())
          centre[c] += 0.5 * magnify * u->values[3 * particle->second + c];
    }
    const double half = 0.5 * (dimension == 2 ? bond.size : std::sqrt(2 * bond.size));
    for (const auto &t : face_tangents(bond.normal)) {
      for (const int side : {-1, 1})
        for (int c = 0; c < 3; ++c)
          segments.points.push_back(centre[c] + side * half * t[c]);
      if (dimension == 2)
        break;
    }
  }
  return segments;
}

Segments box_lines(const std::vector<std::array<double, 6>> &boxes, int dimension)
{
  Segments segments;
  segments.color = zone_color;
  segments.width = 1.5;
  segments.dashed = true;
  for (const auto &box : boxes)
    for (int corner = 0; corner < 1 << dimension; ++corner)
      for (int axis = 0; axis < dimension; ++axis)
        if (!(corner >> axis & 1))
          for (const int end : {corner, corner | 1 << axis})
            for (int c = 0; c < 3; ++c)
              segments.points.push_back(c < dimension ? box[c + 3 * (end >> c & 1)] : 0.);
  return segments;
}
} // namespace

Picture picture_of(const ParticleFields &particles, const CellFields &cells,
                   const std::vector<BrokenBond> &bonds, int dimension, double radius,
                   const FieldView &view)
{
  const double magnify = view.magnify.value_or(good_magnification(particles, cells));
  Picture picture;
  picture.dimension = dimension;
  picture.title = view.title;
  const auto set_label = [&](const Field &field) {
    picture.value_label = label_of(field, view.component);
    picture.value_unit = field.unit;
  };
  if (cells.n_cells() > 0) {
    Quads quads;
    quads.points = moved(cells.reference, find_field(cells.node_fields, "displacement"), magnify);
    quads.corners = visible_faces(cells, view);
    if (const Field *color = find_field(cells.node_fields, view.field)) {
      quads.values = coloring(*color, view.component);
      set_label(*color);
    } else if (const Field *color = find_field(cells.cell_fields, view.field)) {
      quads.values = to_nodes(cells, coloring(*color, view.component));
      set_label(*color);
    }
    picture.quads.push_back(std::move(quads));
  }
  if (particles.size() > 0) {
    picture.scatters.push_back(visible_particles(particles, view, magnify, radius));
    if (const Field *color = find_field(particles.fields, view.field))
      set_label(*color);
  }
  if (!view.boxes.empty())
    picture.segments.push_back(box_lines(view.boxes, dimension));
  if (view.crack && !bonds.empty())
    picture.segments.push_back(broken_faces(particles, bonds, dimension, view, magnify));
  return picture;
}
} // namespace ligament::program
