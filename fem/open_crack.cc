#include "fem/open_crack.h"

#include "core/check.h"
#include "fem/cell_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace ligament::fem
{
namespace
{
using Edge = std::pair<int, int>; // nodes, the smaller one first

Edge edge_of(const Mesh<2> &mesh, int cell, int face)
{
  const auto local = face_nodes<2>(face);
  const int a = mesh.cells[cell][local[0]], b = mesh.cells[cell][local[1]];
  return {std::min(a, b), std::max(a, b)};
}

/// The coarse cell's edge on which the node hangs.
Edge masters_edge(const HangingNode &h)
{
  core::require(h.masters.size() == 2, "a node of the mesh hangs on more than an edge");
  const int a = h.masters[0].first, b = h.masters[1].first;
  return {std::min(a, b), std::max(a, b)};
}

[[noreturn]] void refuse(const Vector<2> &x, const std::string &why)
{
  throw core::InputError(fmt::format("a crack in the far field {} at ({:.4g}, {:.4g}) m; let it "
                                     "follow lines of the mesh, or put it into the discrete zone",
                                     why, x[0], x[1]));
}

/// All edges of cells on the polyline.
class CrackEdges
{
public:
  CrackEdges(const Mesh<2> &mesh, const std::vector<Vector<2>> &polyline)
      : mesh_(mesh), locator_(mesh)
  {
    core::require(polyline.size() >= 2, "a crack needs two points at least; add one");
    for (std::size_t k = 1; k < polyline.size(); ++k)
      add_segment(polyline[k - 1], polyline[k]);
    for (const HangingNode &h : mesh.hanging)
      if (edges_.count(masters_edge(h)) > 0)
        refuse(mesh.nodes[h.node], "runs along a step between cell sizes");
  }
  const std::set<Edge> &edges() const { return edges_; }

private:
  void add_segment(const Vector<2> &from, const Vector<2> &to)
  {
    const Vector<2> along = (to - from).normalized();
    const double length = (to - from).norm();
    std::map<double, double> pieces; // from, to, along the segment
    for (int cell = 0; cell < mesh_.n_cells(); ++cell) {
      const double tolerance = 1e-6 * mesh_.cell_size[cell].minCoeff();
      for (int face = 0; face < 4; ++face) {
        const Edge edge = edge_of(mesh_, cell, face);
        double place[2];
        bool on_line = true;
        for (int end = 0; end < 2; ++end) {
          const Vector<2> x = mesh_.nodes[end ? edge.second : edge.first] - from;
          place[end] = along.dot(x);
          on_line = on_line && std::abs(along[0] * x[1] - along[1] * x[0]) <= tolerance &&
                    place[end] >= -tolerance && place[end] <= length + tolerance;
        }
        if (!on_line)
          continue;
        edges_.insert(edge);
        double &upper = pieces[std::min(place[0], place[1])];
        upper = std::max({upper, place[0], place[1]});
      }
    }
    double covered = 0;
    for (const auto &[lower, upper] : pieces) {
      require_outside(from, along, covered, lower);
      covered = std::max(covered, upper);
    }
    require_outside(from, along, covered, length);
  }

  /// What no edge lies on must lie outside the mesh.
  void require_outside(const Vector<2> &from, const Vector<2> &along, double lower,
                       double upper) const
  {
    const double gap = upper - lower;
    for (const double part : {1e-3, 0.25, 0.5, 0.75, 1 - 1e-3}) {
      const Vector<2> x = from + (lower + part * gap) * along;
      const int cell = locator_.find(x);
      if (cell >= 0 && gap > 2e-6 * mesh_.cell_size[cell].minCoeff())
        refuse(from + lower * along, "leaves the edges of the cells");
    }
  }

  const Mesh<2> &mesh_;
  CellLocator<2> locator_;
  std::set<Edge> edges_;
};

/// Cells around a node, in groups that edges other than the crack's hold together.
std::vector<std::vector<int>> groups_around(const Mesh<2> &mesh, int node,
                                            const std::vector<int> &cells,
                                            const std::set<Edge> &crack,
                                            const std::vector<int> &hanging)
{
  // The neighbours of the node in each cell; along a step between sizes the far end of the coarse
  // cell's edge.
  const int n = int(cells.size());
  std::vector<std::array<int, 2>> ends(n);
  for (int k = 0; k < n; ++k) {
    const auto &corners = mesh.cells[cells[k]];
    const int at = int(std::find(corners.begin(), corners.end(), node) - corners.begin());
    for (int axis = 0; axis < 2; ++axis) {
      const int next = corners[at ^ (1 << axis)];
      int &end = ends[k][axis];
      end = crack.count({std::min(node, next), std::max(node, next)}) > 0 ? -1 : next;
      if (end < 0 || hanging[end] < 0)
        continue;
      const Edge coarse = masters_edge(mesh.hanging[hanging[end]]);
      if (coarse.first == node || coarse.second == node)
        end = coarse.first + coarse.second - node;
    }
  }
  std::vector<int> group(n);
  std::iota(group.begin(), group.end(), 0);
  for (bool changed = true; changed;) {
    changed = false;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (const int a : ends[i])
          for (const int b : ends[j])
            if (a >= 0 && a == b && group[i] < group[j]) {
              group[j] = group[i];
              changed = true;
            }
  }
  std::map<int, std::vector<int>> lists;
  for (int k = 0; k < n; ++k)
    lists[group[k]].push_back(cells[k]);
  std::vector<std::vector<int>> groups;
  for (auto &[first, list] : lists)
    groups.push_back(std::move(list));
  return groups;
}

/// Masters of hanging nodes are the copies that the coarse cell has.
void renew_masters(const Mesh<2> &before, Mesh<2> &mesh)
{
  std::map<Edge, std::pair<int, int>> place_of; // cell and face
  for (int cell = 0; cell < before.n_cells(); ++cell)
    for (int face = 0; face < 4; ++face)
      place_of[edge_of(before, cell, face)] = {cell, face};
  for (HangingNode &h : mesh.hanging) {
    const auto found = place_of.find(masters_edge(h));
    core::require(found != place_of.end(), "a hanging node of the mesh lies on no cell's edge");
    const auto [cell, face] = found->second;
    for (auto &master : h.masters)
      for (const int a : face_nodes<2>(face))
        if (before.cells[cell][a] == master.first) {
          master.first = mesh.cells[cell][a];
          break;
        }
  }
}
} // namespace

void open_crack(Mesh<2> &mesh, const std::vector<Vector<2>> &polyline)
{
  const CrackEdges found(mesh, polyline);
  const std::set<Edge> &crack = found.edges();
  std::vector<int> hanging(mesh.n_nodes(), -1);
  for (std::size_t h = 0; h < mesh.hanging.size(); ++h)
    hanging[mesh.hanging[h].node] = int(h);
  std::map<int, std::vector<int>> cells_of; // around the nodes of the crack
  for (const Edge &edge : crack)
    for (const int node : {edge.first, edge.second})
      if (hanging[node] < 0) // a tip there: the coarse cell's edge holds it together
        cells_of[node];
  for (int cell = 0; cell < mesh.n_cells(); ++cell)
    for (const int node : mesh.cells[cell])
      if (const auto at = cells_of.find(node); at != cells_of.end())
        at->second.push_back(cell);

  Mesh<2> opened = mesh;
  for (const auto &[node, cells] : cells_of) {
    const auto groups = groups_around(mesh, node, cells, crack, hanging);
    for (std::size_t g = 1; g < groups.size(); ++g) {
      for (const int cell : groups[g])
        std::replace(opened.cells[cell].begin(), opened.cells[cell].end(), node, opened.n_nodes());
      opened.nodes.push_back(mesh.nodes[node]);
    }
  }
  renew_masters(mesh, opened);
  std::set<std::pair<int, int>> known;
  for (const auto &face : mesh.boundary_faces)
    known.emplace(face.cell, face.face);
  for (int cell = 0; cell < mesh.n_cells(); ++cell)
    for (int face = 0; face < 4; ++face)
      if (crack.count(edge_of(mesh, cell, face)) > 0 && known.count({cell, face}) == 0)
        opened.boundary_faces.push_back({cell, face, inner_surface<2>});
  mesh = std::move(opened);
}
} // namespace ligament::fem
