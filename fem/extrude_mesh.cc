#include "fem/extrude_mesh.h"

#include "fem/cell_quality.h"

#include <algorithm>
#include <map>

namespace ligament::fem
{
Mesh<3> extrude_mesh(const Mesh<2> &plane, const SectionedAxis &axis,
                     const std::vector<InnerBox<3>> &inner)
{
  Mesh<3> mesh;
  const int n_plane = plane.n_nodes();
  const auto n_layers = int(axis.n());
  std::vector<char> used(std::size_t(n_plane) * (n_layers + 1), 0);
  const auto is_inner = [&](int c, int layer) {
    Vector<3> x;
    x << (plane.nodes[plane.cells[c][0]] + plane.nodes[plane.cells[c][3]]) / 2,
        (axis.position(layer) + axis.position(layer + 1)) / 2;
    return std::any_of(inner.begin(), inner.end(), [&](const auto &box) {
      return ((x - box.lower).array() > 0).all() && ((box.upper - x).array() > 0).all();
    });
  };
  std::vector<int> cell_number(std::size_t(plane.n_cells()) * n_layers, -1);
  for (int layer = 0; layer < n_layers; ++layer)
    for (int c = 0; c < plane.n_cells(); ++c) {
      if (is_inner(c, layer))
        continue;
      cell_number[std::size_t(layer) * plane.n_cells() + c] = mesh.n_cells();
      auto &cell = mesh.cells.emplace_back();
      for (int a = 0; a < 8; ++a) {
        cell[a] = (layer + a / 4) * n_plane + plane.cells[c][a % 4];
        used[cell[a]] = 1;
      }
      mesh.cell_level.push_back(plane.cell_level[c]);
    }
  std::vector<int> number(used.size(), -1);
  for (int layer = 0; layer <= n_layers; ++layer)
    for (int i = 0; i < n_plane; ++i)
      if (const std::size_t k = std::size_t(layer) * n_plane + i; used[k]) {
        number[k] = mesh.n_nodes();
        mesh.nodes.emplace_back(plane.nodes[i][0], plane.nodes[i][1], axis.position(layer));
      }
  for (auto &cell : mesh.cells)
    for (int &node : cell)
      node = number[node];
  for (int layer = 0; layer <= n_layers; ++layer)
    for (const HangingNode &old : plane.hanging) {
      HangingNode hanging{number[layer * n_plane + old.node], {}};
      bool is_there = hanging.node >= 0;
      for (const auto &[master, weight] : old.masters) {
        hanging.masters.emplace_back(number[layer * n_plane + master], weight);
        is_there = is_there && hanging.masters.back().first >= 0;
      }
      if (is_there)
        mesh.hanging.push_back(std::move(hanging));
    }
  // Around: the plane's faces; at the ends the box's sides; towards inner boxes free.
  std::map<std::pair<int, int>, int> around;
  for (const auto &face : plane.boundary_faces)
    around[{face.cell, face.face}] = face.boundary;
  const CellLocator<2> locator(plane);
  for (int layer = 0; layer < n_layers; ++layer)
    for (int c = 0; c < plane.n_cells(); ++c) {
      const int cell = cell_number[std::size_t(layer) * plane.n_cells() + c];
      if (cell < 0)
        continue;
      for (int f = 0; f < 4; ++f) {
        if (const auto face = around.find({c, f}); face != around.end()) {
          const bool is_free = face->second == inner_surface<2>;
          mesh.boundary_faces.push_back({cell, f, is_free ? inner_surface<3> : face->second});
          continue;
        }
        static constexpr int ends[4][2] = {{2, 0}, {1, 3}, {0, 1}, {3, 2}};
        const Vector<2> &a = plane.nodes[plane.cells[c][ends[f][0]]],
                        &b = plane.nodes[plane.cells[c][ends[f][1]]], way = b - a;
        const int beside = locator.find((a + b) / 2 + 1e-3 * Vector<2>(way[1], -way[0]));
        if (beside >= 0 && cell_number[std::size_t(layer) * plane.n_cells() + beside] < 0)
          mesh.boundary_faces.push_back({cell, f, inner_surface<3>});
      }
      for (const int up : {0, 1}) {
        const int next = layer + (up ? 1 : -1);
        if (next < 0 || next == n_layers)
          mesh.boundary_faces.push_back({cell, 4 + up, 4 + up});
        else if (cell_number[std::size_t(next) * plane.n_cells() + c] < 0)
          mesh.boundary_faces.push_back({cell, 4 + up, inner_surface<3>});
      }
    }
  find_cell_shapes(mesh);
  return mesh;
}
} // namespace ligament::fem
