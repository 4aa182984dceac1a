#include "fem/condensed_cell.h"

#include "core/check.h"

#include <Eigen/LU>

#include <algorithm>

namespace ligament::fem
{
template <int dim>
CellCondenser<dim>::CellCondenser(const Mesh<dim> &mesh) : mesh_(mesh), hanging_(mesh.n_nodes(), -1)
{
  for (std::size_t h = 0; h < mesh.hanging.size(); ++h)
    hanging_[mesh.hanging[h].node] = int(h);
}

template <int dim>
bool CellCondenser<dim>::hangs(int cell) const
{
  const auto &corners = mesh_.cells[cell];
  return std::any_of(corners.begin(), corners.end(), [&](int node) { return hanging_[node] >= 0; });
}

template <int dim>
CondensedCell<dim> CellCondenser<dim>::operator()(int cell) const
{
  constexpr int nc = n_cell_nodes<dim>;
  CondensedCell<dim> condensed;
  condensed.nodes = mesh_.cells[cell];
  for (int a = 0; a < nc; ++a)
    if (mesh_.is_box(cell))
      condensed.place.col(a) = corner<dim>(mesh_.cell_size[cell], a);
    else
      condensed.place.col(a) = mesh_.nodes[mesh_.cells[cell][a]] - mesh_.cell_lower[cell];
  if (!hangs(cell))
    return condensed;

  const auto &corners = mesh_.cells[cell];
  auto &nodes = condensed.nodes;
  std::vector<int> empty; // places of hanging corners
  for (int a = 0; a < nc; ++a)
    if (hanging_[corners[a]] >= 0) {
      empty.push_back(a);
      nodes[a] = -1;
    }
  for (const int a : std::vector<int>(empty)) {
    condensed.shares.row(a).setZero();
    for (const auto &[master, weight] : mesh_.hanging[hanging_[corners[a]]].masters) {
      auto place = std::find(nodes.begin(), nodes.end(), master);
      if (place == nodes.end()) {
        // The masters of a cell's corners are corners of the cell that was refined: 2^dim in all.
        core::require(!empty.empty(), "a cell of the mesh follows more nodes than it has corners");
        place = nodes.begin() + empty.front();
        *place = master;
        empty.erase(empty.begin());
      }
      condensed.shares(a, place - nodes.begin()) = weight;
    }
  }
  core::require(empty.empty(), "a cell of the mesh follows fewer nodes than it has corners");
  // Corners follow their masters in place, too.
  condensed.place = (condensed.place * condensed.shares.transpose().inverse()).eval();
  return condensed;
}

template class CellCondenser<2>;
template class CellCondenser<3>;
} // namespace ligament::fem
