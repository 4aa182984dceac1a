#include "core/check.h"
#include "fem/extrude_mesh.h"
#include "fem/fit_outline.h"
#include "fem/mesh.h"
#include "fem/sectioned_axis.h"

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/affine_constraints.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace ligament::fem
{
namespace
{
using Index = SectionedAxis::Index;

template <int dim>
using Lattice = std::array<Index, dim>;

/// The directions, and what is left out, in indices.
template <int dim>
struct Grid
{
  struct Part
  {
    Lattice<dim> begin, end;
  };
  std::vector<SectionedAxis> axes;
  std::vector<Part> inner;

  const SectionedAxis &operator[](int k) const { return axes[k]; }

  /// Distance of a cell from a part, 0 where they meet.
  static Index distance(const Part &part, const Lattice<dim> &lower, Index size)
  {
    Index d = 0;
    for (int k = 0; k < dim; ++k)
      d = std::max({d, part.begin[k] - (lower[k] + size), lower[k] - part.end[k]});
    return d;
  }

  bool is_inner(const Lattice<dim> &lower, Index size) const
  {
    return std::any_of(inner.begin(), inner.end(), [&](const Part &part) {
      for (int k = 0; k < dim; ++k)
        if (lower[k] < part.begin[k] || lower[k] + size > part.end[k])
          return false;
      return true;
    });
  }
};

template <int dim>
std::vector<InnerBox<dim>> inner_boxes(const MeshParameters<dim> &p)
{
  std::vector<InnerBox<dim>> boxes;
  for (const auto &box : p.inner)
    if ((box.upper - box.lower).minCoeff() > 0)
      boxes.push_back(box);
  return boxes;
}

constexpr const char *axis_name = "xyz";

template <int dim>
void check_parameters(const MeshParameters<dim> &p)
{
  for (int k = 0; k < dim; ++k)
    core::require(p.upper[k] > p.lower[k] && std::isfinite(p.upper[k] - p.lower[k]),
                  fmt::format("far-field mesh: the specimen has no extent in {} ({} m to {} m); "
                              "give an upper corner above the lower one",
                              axis_name[k], p.lower[k], p.upper[k]));
  core::require(p.cell_size > 0 && std::isfinite(p.cell_size),
                fmt::format("far-field mesh: cell size {} m is not positive", p.cell_size));
  core::require(p.levels >= 0 && p.levels <= 20,
                fmt::format("far-field mesh: {} levels; allowed are 0 to 20", p.levels));
  core::require(p.fine_cells >= 0 && p.cells_per_level >= 1,
                fmt::format("far-field mesh: fine cells ({}) must be at least 0, cells per level "
                            "({}) at least 1",
                            p.fine_cells, p.cells_per_level));
  core::require(
      p.growth >= 1 && p.growth <= 2,
      fmt::format("far-field mesh: cells grow by {}; allowed are factors of 1 to 2", p.growth));
}

/// Sections that get cells must not be thinner than their largest cells: squeezed cells would
/// govern the time step and refinement could not follow the requested distances.
template <int dim>
void check_section(const SectionedAxis::Section &s, int k, const MeshParameters<dim> &p,
                   double base_size)
{
  const double length = s.upper - s.lower;
  if (length >= 0.75 * base_size)
    return;
  const int levels = int(std::floor(std::log2(length / (0.75 * p.cell_size))));
  throw core::InputError(fmt::format(
      "far-field mesh: the section {} = {:.6g} m to {:.6g} m is {:.6g} m wide, thinner than "
      "one cell of {:.6g} m (cell size {:.6g} m, {} levels); {}",
      axis_name[k], s.lower, s.upper, length, base_size, p.cell_size, p.levels,
      levels >= 0 ? fmt::format("use at most {} levels or widen the section", levels)
                  : "use smaller cells or widen the section"));
}

/// Checks the sections beside every block of the grid that gets cells.
template <int dim>
void check_sections(const Grid<dim> &grid, const MeshParameters<dim> &p, double base_size)
{
  std::size_t n_blocks = 1;
  for (const auto &axis : grid.axes)
    n_blocks *= axis.sections().size();
  bool leaves_room = false;
  for (std::size_t block = 0; block < n_blocks; ++block) {
    std::array<const SectionedAxis::Section *, dim> sections;
    Lattice<dim> lower;
    std::size_t rest = block;
    for (int k = 0; k < dim; ++k) {
      const auto &all = grid[k].sections();
      sections[k] = &all[rest % all.size()];
      rest /= all.size();
      lower[k] = sections[k]->begin;
    }
    if (grid.is_inner(lower, 1))
      continue;
    leaves_room = true;
    for (int k = 0; k < dim; ++k)
      check_section(*sections[k], k, p, base_size);
  }
  core::require(leaves_room, "far-field mesh: the discrete zone fills the whole specimen; make it "
                             "smaller or do without far field");
}

/// Adds the sides of the outline that lie well apart from all other lines; returns them.
template <int dim>
std::vector<double> add_outline_cuts(const MeshParameters<dim> &p, int axis, double base_size,
                                     std::vector<double> &cuts)
{
  if (!p.outline || axis == 2)
    return {};
  const double tolerance = 1e-9 * (p.upper[axis] - p.lower[axis]);
  std::vector<double> lines = {p.lower[axis], p.upper[axis]}, taken;
  lines.insert(lines.end(), cuts.begin(), cuts.end());
  const auto becomes_line = [&](double place) {
    double nearest = 1e300;
    for (const double line : lines)
      nearest = std::min(nearest, std::abs(place - line));
    if (nearest > tolerance && nearest < 0.75 * base_size)
      return false;
    if (nearest > tolerance)
      lines.push_back(place), cuts.push_back(place);
    return true;
  };
  for (const double place : straight_sides(*p.outline, axis, 0.75 * p.cell_size))
    if (becomes_line(place))
      taken.push_back(place);
  for (const double place : ends_of_names(*p.outline, axis))
    becomes_line(place);
  return taken;
}

/// `lines`: those sides of the outline that became lines of the grid, by axis.
template <int dim>
Grid<dim> make_grid(const MeshParameters<dim> &p, int levels, double base_size,
                    std::array<std::vector<double>, 2> &lines)
{
  const auto boxes = inner_boxes(p);
  Grid<dim> grid;
  double n_base = 1;
  for (int k = 0; k < dim; ++k) {
    std::vector<double> cuts;
    SectionedAxis::Growth growth = {boxes.empty() ? 1 : p.growth,
                                    std::max(1, p.fine_cells),
                                    std::ldexp(p.cell_size, p.levels),
                                    {}};
    for (const auto &box : boxes) {
      core::require(box.lower[k] < p.upper[k] && box.upper[k] > p.lower[k],
                    fmt::format("far-field mesh: the discrete zone ({:.6g} m to {:.6g} m in {}) "
                                "lies outside the specimen; move it inside",
                                box.lower[k], box.upper[k], axis_name[k]));
      cuts.push_back(box.lower[k]);
      cuts.push_back(box.upper[k]);
      growth.covered.emplace_back(box.lower[k], box.upper[k]);
    }
    const auto taken = add_outline_cuts(p, k, base_size, cuts);
    if (k < 2)
      lines[k] = taken;
    grid.axes.emplace_back(p.lower[k], p.upper[k], cuts, base_size, levels, growth);
    n_base *= double(grid[k].n() >> levels);
    core::require(n_base < 1e8, fmt::format("far-field mesh: more than 1e8 cells of {:.6g} m; use "
                                            "larger cells or more levels",
                                            base_size));
  }
  for (const auto &box : boxes) {
    auto &part = grid.inner.emplace_back();
    for (int k = 0; k < dim; ++k) {
      part.begin[k] = grid[k].index(std::max(box.lower[k], p.lower[k]));
      part.end[k] = grid[k].index(std::min(box.upper[k], p.upper[k]));
    }
  }
  check_sections<dim>(grid, p, base_size);
  return grid;
}

/// Base cells outside the inner boxes.
template <int dim>
void make_base_mesh(const Grid<dim> &grid, Index base, dealii::Triangulation<dim> &triangulation)
{
  Lattice<dim> n_points;
  Index n_cells = 1, total_points = 1;
  for (int k = 0; k < dim; ++k) {
    n_points[k] = grid[k].n() / base + 1;
    n_cells *= n_points[k] - 1;
    total_points *= n_points[k];
  }
  constexpr unsigned int none = dealii::numbers::invalid_unsigned_int;
  std::vector<unsigned int> vertex_number(total_points, none);
  std::vector<dealii::Point<dim>> vertices;
  std::vector<dealii::CellData<dim>> cells;
  for (Index c = 0; c < n_cells; ++c) {
    Lattice<dim> lower;
    Lattice<dim> finest;
    Index rest = c;
    for (int k = 0; k < dim; ++k) {
      lower[k] = rest % (n_points[k] - 1);
      rest /= n_points[k] - 1;
      finest[k] = lower[k] * base;
    }
    if (grid.is_inner(finest, base))
      continue;
    cells.emplace_back();
    for (int v = 0; v < n_cell_nodes<dim>; ++v) {
      Index number = 0;
      dealii::Point<dim> p;
      for (int k = dim - 1; k >= 0; --k) {
        const Index i = lower[k] + (v >> k & 1);
        number = number * n_points[k] + i;
        p[k] = grid[k].position(i * base);
      }
      if (vertex_number[number] == none) {
        vertex_number[number] = vertices.size();
        vertices.push_back(p);
      }
      cells.back().vertices[v] = vertex_number[number];
    }
  }
  triangulation.create_triangulation(vertices, cells, {});
}

template <int dim>
Lattice<dim> lattice_point(const Grid<dim> &grid, const dealii::Point<dim> &p)
{
  Lattice<dim> i;
  for (int k = 0; k < dim; ++k)
    i[k] = grid[k].index(p[k]);
  return i;
}

/// Refines what is nearer to an inner box than its size allows. The first distance has one cell
/// more than asked for: hanging nodes then lie beyond the fine region, not on its border. Cells of
/// `extra` levels below those beside the boxes lie along the outline, three of them.
template <int dim>
void refine(const Grid<dim> &grid, const MeshParameters<dim> &p, int levels, int extra,
            const SlantedSides *sides, int outline_level, dealii::Triangulation<dim> &triangulation)
{
  const double finest = std::ldexp(p.cell_size, -extra);
  for (int level = levels; level > 0; --level) {
    Index required = (p.fine_cells + 1) * (Index(1) << extra);
    Index along = 3 * (Index(1) << outline_level);
    for (int l = 1; l < level; ++l) {
      if (l > extra)
        required += p.cells_per_level * (Index(1) << l);
      if (l > outline_level)
        along += p.cells_per_level * (Index(1) << l);
    }
    const Index size = Index(1) << level;
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->level() == levels - level) {
        const Lattice<dim> lower = lattice_point<dim>(grid, cell->vertex(0));
        for (const auto &part : grid.inner)
          if (level > extra && grid.distance(part, lower, size) < required)
            cell->set_refine_flag();
        if (!sides || level <= outline_level)
          continue;
        const auto &a = cell->vertex(0), &b = cell->vertex((1 << dim) - 1);
        if (sides->come_near({a[0], a[1]}, {b[0], b[1]}, double(along) * finest))
          cell->set_refine_flag();
      }
    triangulation.execute_coarsening_and_refinement();
  }
}

/// Order of rows: x fastest, so that the cells of a row and their nodes lie side by side.
template <int dim>
std::vector<int> row_order(const std::vector<Lattice<dim>> &points)
{
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return std::lexicographical_compare(points[a].rbegin(), points[a].rend(), points[b].rbegin(),
                                        points[b].rend());
  });
  return order;
}

template <int dim>
void add_cells(const Grid<dim> &grid, int levels, const dealii::DoFHandler<dim> &dofs,
               Mesh<dim> &mesh, std::vector<int> &node_of_dof)
{
  std::vector<Lattice<dim>> node_points(dofs.n_dofs()), cell_points;
  std::vector<int> cell_levels;
  std::vector<std::array<int, n_cell_nodes<dim>>> cells;
  std::vector<dealii::types::global_dof_index> indices(n_cell_nodes<dim>);
  for (const auto &cell : dofs.active_cell_iterators()) {
    cell->get_dof_indices(indices);
    cells.emplace_back();
    for (int v = 0; v < n_cell_nodes<dim>; ++v) {
      cells.back()[v] = int(indices[v]);
      node_points[indices[v]] = lattice_point<dim>(grid, cell->vertex(v));
    }
    cell_points.push_back(lattice_point<dim>(grid, cell->vertex(0)));
    cell_levels.push_back(levels - cell->level());
  }

  node_of_dof.resize(dofs.n_dofs());
  for (const int dof : row_order<dim>(node_points)) {
    node_of_dof[dof] = mesh.n_nodes();
    Vector<dim> x;
    for (int k = 0; k < dim; ++k)
      x[k] = grid[k].position(node_points[dof][k]);
    mesh.nodes.push_back(x);
  }
  for (const int c : row_order<dim>(cell_points)) {
    const Lattice<dim> &lower = cell_points[c];
    const Index size = Index(1) << cell_levels[c];
    Vector<dim> h;
    for (int k = 0; k < dim; ++k) {
      // From the section, not from the corners: equal cells have sizes equal to the last bit.
      h[k] = grid[k].finest_size(lower[k]) * double(size);
      for (int side = 0; side < 2; ++side) {
        const Index face = lower[k] + side * size;
        const int normal = 2 * k + side;
        if (face == (side ? grid[k].n() : 0))
          mesh.boundary_faces.push_back({mesh.n_cells(), normal, normal});
        else {
          Lattice<dim> beyond = lower;
          beyond[k] += side ? size : -size;
          if (grid.is_inner(beyond, size))
            mesh.boundary_faces.push_back({mesh.n_cells(), normal, inner_surface<dim>});
        }
      }
    }
    mesh.cells.emplace_back();
    for (int v = 0; v < n_cell_nodes<dim>; ++v)
      mesh.cells.back()[v] = node_of_dof[cells[c][v]];
    mesh.cell_lower.push_back(mesh.nodes[mesh.cells.back()[0]]);
    mesh.cell_size.push_back(h);
    mesh.cell_level.push_back(cell_levels[c]);
  }
}

template <int dim>
void add_hanging_nodes(const dealii::DoFHandler<dim> &dofs, const std::vector<int> &node_of_dof,
                       Mesh<dim> &mesh)
{
  dealii::AffineConstraints<double> constraints;
  dealii::DoFTools::make_hanging_node_constraints(dofs, constraints);
  constraints.close();
  for (const auto &line : constraints.get_lines()) {
    HangingNode hanging{node_of_dof[line.index], {}};
    for (const auto &[dof, weight] : line.entries)
      hanging.masters.emplace_back(node_of_dof[dof], weight);
    std::sort(hanging.masters.begin(), hanging.masters.end());
    mesh.hanging.push_back(hanging);
  }
  std::sort(mesh.hanging.begin(), mesh.hanging.end(),
            [](const HangingNode &a, const HangingNode &b) { return a.node < b.node; });
}

/// A mesh of boxes around inner boxes, and the lines of the outline in it.
template <int dim>
Mesh<dim> make_boxes(const MeshParameters<dim> &p, bool keeps_inner,
                     std::array<std::vector<double>, 2> &lines)
{
  const bool refines = p.growth == 1 && (!inner_boxes(p).empty() || p.outline);
  // Levels of cells below those beside inner boxes, and the level of those along the outline.
  int extra = 0, outline_level = 0;
  if (p.outline && p.outline_cell_size > 0 && refines) {
    const double ratio = std::log2(p.outline_cell_size / p.cell_size);
    extra = std::max(0, int(std::ceil(-ratio - 0.01)));
    outline_level = ratio > 0 ? std::min(p.levels, int(std::floor(ratio + 0.01))) : 0;
  }
  const int levels = refines ? p.levels + extra : 0;
  Grid<dim> grid = make_grid(p, levels, std::ldexp(p.cell_size, levels - extra), lines);
  const auto inner = grid.inner;
  std::optional<SlantedSides> sides;
  if (p.outline)
    sides.emplace(*p.outline, lines);
  if (sides && levels > 0 && inner.empty() && !sides->any()) { // small cells are wanted nowhere
    MeshParameters<dim> even = p;
    even.levels = 0;
    even.outline_cell_size = 0;
    return make_boxes(even, keeps_inner, lines);
  }
  if (keeps_inner)
    grid.inner.clear();

  dealii::Triangulation<dim> triangulation(
      dealii::Triangulation<dim>::limit_level_difference_at_vertices);
  make_base_mesh(grid, Index(1) << levels, triangulation);
  grid.inner = inner;
  refine(grid, p, levels, extra, sides ? &*sides : nullptr, outline_level, triangulation);
  if (keeps_inner)
    grid.inner.clear();

  const dealii::FE_Q<dim> element(1);
  dealii::DoFHandler<dim> dofs(triangulation);
  dofs.distribute_dofs(element);
  core::require(
      dofs.n_dofs() < (1u << 31) / dim,
      fmt::format("far-field mesh: {} nodes are too many; use larger cells or more levels",
                  dofs.n_dofs()));

  Mesh<dim> mesh;
  std::vector<int> node_of_dof;
  add_cells(grid, levels, dofs, mesh, node_of_dof);
  add_hanging_nodes(dofs, node_of_dof, mesh);
  return mesh;
}
} // namespace

template <int dim>
Mesh<dim> make_mesh(const MeshParameters<dim> &p)
{
  check_parameters(p);
  std::array<std::vector<double>, 2> lines;
  if (!p.outline)
    return make_boxes(p, false, lines);
  if constexpr (dim == 2)
    return fit_outline(make_boxes(p, false, lines), *p.outline, lines);
  else {
    MeshParameters<2> plane;
    plane.lower = p.lower.template head<2>();
    plane.upper = p.upper.template head<2>();
    plane.cell_size = p.cell_size;
    plane.levels = p.levels;
    plane.fine_cells = p.fine_cells;
    plane.cells_per_level = p.cells_per_level;
    plane.growth = p.growth;
    plane.outline = p.outline;
    plane.outline_cell_size = p.outline_cell_size;
    std::vector<double> cuts;
    SectionedAxis::Growth growth = {p.inner.empty() ? 1 : p.growth,
                                    std::max(1, p.fine_cells),
                                    std::ldexp(p.cell_size, p.levels),
                                    {}};
    for (const auto &box : p.inner) {
      plane.inner.push_back({box.lower.template head<2>(), box.upper.template head<2>()});
      cuts.push_back(box.lower[2]);
      cuts.push_back(box.upper[2]);
      growth.covered.emplace_back(box.lower[2], box.upper[2]);
    }
    const SectionedAxis axis(p.lower[2], p.upper[2], cuts, p.cell_size, 0, growth);
    return extrude_mesh(fit_outline(make_boxes(plane, true, lines), *p.outline, lines), axis,
                        p.inner);
  }
}

template Mesh<2> make_mesh<2>(const MeshParameters<2> &);
template Mesh<3> make_mesh<3>(const MeshParameters<3> &);
} // namespace ligament::fem
