#include "src/drawing/field_view.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

namespace ligament::program
{
namespace
{
constexpr Color crack_color = {225, 25, 60}, cut_color = {40, 40, 40}, tool_color = {70, 70, 90};

/// One number per item for the colour: a component, or the length of a vector.
std::vector<double> coloring(const Field &field, int component)
{
  const int n = field.n_components();
  if (n == 1)
    return field.values;
  std::vector<double> values(field.values.size() / n);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double *v = &field.values[n * i];
    values[i] = component >= 0 ? v[component] : std::hypot(v[0], v[1], v[2]);
  }
  return values;
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

double largest_displacement(const BodyState &state)
{
  double largest = 0;
  for (const auto *fields : {&state.particles.fields, &state.cells.node_fields})
    if (const Field *u = find_field(*fields, "displacement"))
      for (const double value : u->values)
        largest = std::max(largest, std::abs(value));
  return largest;
}

double size_of(const BodyState &state)
{
  double lower[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, upper[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (const auto *points : {&state.particles.reference, &state.cells.reference})
    for (std::size_t i = 0; i < points->size(); ++i) {
      lower[i % 3] = std::min(lower[i % 3], (*points)[i]);
      upper[i % 3] = std::max(upper[i % 3], (*points)[i]);
    }
  return std::hypot(upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]);
}

/// The largest of 1, 2 or 5 times a power of ten up to x.
double round_down(double x)
{
  const double power = std::pow(10, std::floor(std::log10(x) + 1e-9)), lead = x / power;
  return power * (lead >= 5 ? 5 : lead >= 2 ? 2 : 1);
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

Scatter visible_particles(const ParticleFields &particles, const FieldView &view, double magnify)
{
  Scatter all;
  const Field *color = find_field(particles.fields, view.field.field);
  const Field *radius = find_field(particles.fields, "radius");
  const auto values = color ? coloring(*color, view.field.component) : std::vector<double>();
  const auto positions =
      moved(particles.reference, find_field(particles.fields, "displacement"), magnify);
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (!is_cut(view, &particles.reference[3 * i])) {
      all.positions.insert(all.positions.end(), &positions[3 * i], &positions[3 * i] + 3);
      all.radii.push_back(radius ? radius->values[i] : 0);
      if (color)
        all.values.push_back(values[i]);
    }
  return all;
}

/// Both flanks of broken faces, each with its particle: lines in 2D, outlines of squares of the
/// faces' sizes in 3D.
class BrokenFaces
{
public:
  BrokenFaces(const ParticleFields &particles, int dimension, double magnify, Color color)
      : u_(find_field(particles.fields, "displacement")), dimension_(dimension), magnify_(magnify)
  {
    lines_.color = color;
    lines_.width = dimension == 2 ? 2.5 : 1.2;
    if (const Field *ids = find_field(particles.fields, "global_id"))
      for (std::size_t i = 0; i < particles.size(); ++i)
        particle_[std::int64_t(ids->values[i])] = i;
  }

  void add(const BrokenBond &bond)
  {
    for (const std::int64_t id : {bond.i, bond.j}) {
      std::array<double, 3> centre;
      const auto particle = particle_.find(id);
      for (int c = 0; c < 3; ++c)
        centre[c] = bond.centroid[c] + (u_ && particle != particle_.end()
                                            ? magnify_ * u_->values[3 * particle->second + c]
                                            : 0);
      add_outline(bond, centre);
    }
  }

  const Segments &lines() const { return lines_; }

private:
  void add_outline(const BrokenBond &bond, const std::array<double, 3> &centre)
  {
    const auto [t, s] = face_tangents(bond.normal);
    const double half = 0.5 * (dimension_ == 2 ? bond.size : std::sqrt(bond.size));
    static constexpr double along_t[] = {-1, 1, 1, -1}, along_s[] = {-1, -1, 1, 1};
    const auto corner = [&, &t = t, &s = s](int k) {
      for (int c = 0; c < 3; ++c)
        lines_.points.push_back(centre[c] + half * (along_t[k % 4] * t[c] +
                                                    (dimension_ == 3 ? along_s[k % 4] * s[c] : 0)));
    };
    for (int k = 0; k < (dimension_ == 2 ? 1 : 4); ++k) {
      corner(k);
      corner(k + 1);
    }
  }

  const Field *u_;
  int dimension_;
  double magnify_;
  std::unordered_map<std::int64_t, std::size_t> particle_;
  Segments lines_;
};

Quads visible_cells(const CellFields &cells, const FieldView &view, double magnify)
{
  Quads quads;
  quads.points = moved(cells.reference, find_field(cells.node_fields, "displacement"), magnify);
  quads.corners = visible_faces(cells, view);
  const int component = view.field.component;
  if (const Field *color = find_field(cells.node_fields, view.field.field))
    quads.values = coloring(*color, component);
  else if (const Field *color = find_field(cells.cell_fields, view.field.field))
    quads.values = to_nodes(cells, coloring(*color, component));
  return quads;
}
} // namespace

double good_magnification(const std::vector<const BodyState *> &states)
{
  double factor = HUGE_VAL;
  for (const BodyState *state : states)
    if (const double largest = largest_displacement(*state); largest > 0)
      factor = std::min(factor, (state == states[0] ? 0.03 : 0.06) * size_of(*state) / largest);
  if (!std::isfinite(factor))
    return 0;
  return factor > 1 ? round_down(factor) : 1;
}

Picture picture_of(const BodyState &state, int dimension, const FieldView &view)
{
  const double magnify = view.magnify.value_or(good_magnification({&state}));
  Picture picture;
  picture.dimension = dimension;
  picture.title = state.caption;
  picture.value_label = view.field.label();
  picture.value_unit = view.field.unit();
  if (magnify > 0)
    picture.notes.push_back(fmt::format("displacements × {:g}", magnify));
  if (state.cells.n_cells() > 0)
    picture.quads.push_back(visible_cells(state.cells, view, magnify));
  if (state.particles.size() > 0)
    picture.scatters.push_back(visible_particles(state.particles, view, magnify));
  const auto add_faces = [&](const std::vector<BrokenBond> &bonds, Color color, const char *name) {
    if (!view.crack || bonds.empty())
      return;
    BrokenFaces faces(state.particles, dimension, magnify, color);
    for (const BrokenBond &bond : bonds)
      if (!is_cut(view, bond.centroid))
        faces.add(bond);
    picture.segments.push_back(faces.lines());
    picture.legend.push_back({name, color, LegendEntry::Mark::line});
  };
  add_faces(state.cuts, cut_color, "initial crack");
  add_faces(state.bonds, crack_color, "broken faces");
  for (const ToolOutline &tool : state.tools)
    if (!tool.points.empty()) {
      Segments lines;
      lines.color = tool_color;
      lines.width = dimension == 2 ? 2.5 : 1.5;
      lines.points = turned_points(tool);
      for (std::size_t k = 0; k < lines.points.size(); ++k)
        lines.points[k] += (magnify > 0 ? magnify : 1) * tool.displacement[k % 3];
      picture.segments.push_back(std::move(lines));
    }
  return picture;
}

std::vector<Picture> pictures_of(const std::vector<const BodyState *> &states, int dimension,
                                 const FieldView &view)
{
  FieldView common = view;
  if (!common.magnify)
    common.magnify = good_magnification(states);
  std::vector<Picture> pictures;
  for (const BodyState *state : states)
    pictures.push_back(picture_of(*state, dimension, common));
  const ValueRange range = value_range(pictures);
  for (Picture &picture : pictures)
    picture.range = range;
  return pictures;
}
} // namespace ligament::program
