#include "fem/import_mesh.h"

#include "core/check.h"
#include "fem/cell_quality.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace ligament::fem
{
namespace
{
constexpr double tolerance = 1e-9; // of a cell

/// Counter-clockwise, the first edge the one that points along x most: rectangles along the axes
/// then have their own axes along these.
std::array<int, 4> in_order(std::array<int, 4> quad, const std::vector<Vector<2>> &x)
{
  double area = 0;
  for (int k = 0; k < 4; ++k)
    area += x[quad[k]][0] * x[quad[(k + 1) % 4]][1] - x[quad[k]][1] * x[quad[(k + 1) % 4]][0];
  if (area < 0)
    std::swap(quad[1], quad[3]);
  int first = 0;
  double most = -2;
  for (int k = 0; k < 4; ++k)
    if (const double along = (x[quad[(k + 1) % 4]] - x[quad[k]]).normalized()[0]; along > most) {
      most = along;
      first = k;
    }
  std::rotate(quad.begin(), quad.begin() + first, quad.end());
  return {quad[0], quad[1], quad[3], quad[2]};
}

/// Coordinates that differ by rounding alone become equal, so that rectangles are ones.
void align(const std::vector<std::array<int, 4>> &quads, std::vector<Vector<2>> &places)
{
  double shortest = 1e300;
  for (const auto &quad : quads)
    for (int k = 0; k < 4; ++k)
      shortest = std::min(shortest, (places[quad[(k + 1) % 4]] - places[quad[k]]).norm());
  std::vector<int> order(places.size());
  std::iota(order.begin(), order.end(), 0);
  for (int c = 0; c < 2; ++c) {
    std::sort(order.begin(), order.end(),
              [&](int a, int b) { return places[a][c] < places[b][c]; });
    double before = -1e300, value = 0;
    for (const int i : order) {
      if (places[i][c] - before > tolerance * shortest)
        value = places[i][c];
      before = places[i][c];
      places[i][c] = value;
    }
  }
}

/// Two nodes in one place would be a slit without width, which is free.
void require_one_node_each(const std::vector<std::array<int, 4>> &quads,
                           const std::vector<Vector<2>> &places)
{
  std::map<std::pair<double, double>, int> node_at;
  for (const auto &quad : quads)
    for (const int node : quad) {
      const Vector<2> &x = places[node];
      const int first = node_at.emplace(std::pair(x[0], x[1]), node).first->second;
      core::require(first == node,
                    fmt::format("two nodes lie at ({:.6g}, {:.6g}) m, so that the cells beside "
                                "them are not joined; merge them (gmsh: Coherence)",
                                x[0], x[1]));
    }
}

/// Whether the boxes hold the cell; throws where one of them cuts it.
bool is_left_out(const CellVectors<2> &corners, const std::vector<InnerBox<2>> &inner)
{
  const Vector<2> lower = corners.rowwise().minCoeff(), upper = corners.rowwise().maxCoeff();
  const double slack = 1e-6 * (upper - lower).minCoeff();
  for (const auto &box : inner) {
    const bool meets =
        ((upper - box.lower).array() > slack).all() && ((box.upper - lower).array() > slack).all();
    if (!meets)
      continue;
    const bool holds = ((lower - box.lower).array() > -slack).all() &&
                       ((box.upper - upper).array() > -slack).all();
    core::require(holds,
                  fmt::format("the border between the discrete zone alone and its overlap cuts the "
                              "cell at ({:.6g}, {:.6g}) m; let it run along edges of cells",
                              corners.row(0).mean(), corners.row(1).mean()));
    return true;
  }
  return false;
}
} // namespace

Mesh<2> import_mesh(const std::vector<Vector<2>> &given,
                    const std::vector<std::array<int, 4>> &quads, const core::Solid<2> &outline,
                    const std::vector<InnerBox<2>> &inner)
{
  std::vector<Vector<2>> places = given;
  align(quads, places);
  require_one_node_each(quads, places);
  Mesh<2> mesh;
  std::vector<int> number(places.size(), -1);
  for (const auto &quad : quads) {
    const auto ordered = in_order(quad, places);
    CellVectors<2> corners;
    for (int a = 0; a < 4; ++a)
      corners.col(a) = places[ordered[a]];
    if (is_left_out(corners, inner))
      continue;
    mesh.cells.push_back(ordered);
    for (const int node : ordered)
      number[node] = 0;
  }
  core::require(!mesh.cells.empty(), "the file leaves no cells beside the discrete zone");
  for (std::size_t i = 0; i < places.size(); ++i)
    if (number[i] == 0) {
      number[i] = mesh.n_nodes();
      mesh.nodes.push_back(places[i]);
    }
  for (auto &cell : mesh.cells)
    for (int &node : cell)
      node = number[node];
  mesh.cell_level.assign(mesh.cells.size(), 0);

  static constexpr int ends[4][2] = {{2, 0}, {1, 3}, {0, 1}, {3, 2}};
  std::map<std::pair<int, int>, int> n_cells;
  for (const auto &cell : mesh.cells)
    for (const auto &[a, b] : ends)
      ++n_cells[std::minmax(cell[a], cell[b])];
  for (int c = 0; c < mesh.n_cells(); ++c)
    for (int f = 0; f < 4; ++f) {
      const auto &cell = mesh.cells[c];
      const int a = cell[ends[f][0]], b = cell[ends[f][1]];
      if (n_cells.at(std::minmax(a, b)) > 1)
        continue;
      const Vector<2> middle = (mesh.nodes[a] + mesh.nodes[b]) / 2;
      const double length = (mesh.nodes[b] - mesh.nodes[a]).norm();
      const auto foot = outline.nearest(middle);
      if (foot.distance <= 1e3 * tolerance * length) {
        mesh.boundary_faces.push_back({c, f, outline.facets()[foot.facet].boundary});
        continue;
      }
      const bool faces_zone = std::any_of(inner.begin(), inner.end(), [&](const auto &box) {
        return ((middle - box.lower).array() > -1e-6 * length).all() &&
               ((box.upper - middle).array() > -1e-6 * length).all();
      });
      core::require(faces_zone,
                    fmt::format("the cells end inside the body at ({:.6g}, {:.6g}) m; mesh all of "
                                "it by quadrilaterals, and leave openings to the file",
                                middle[0], middle[1]));
      mesh.boundary_faces.push_back({c, f, inner_surface<2>});
    }
  find_cell_shapes(mesh);
  require_convex(mesh);
  return mesh;
}
} // namespace ligament::fem
