// Cells whose hanging corners are eliminated: their motion by the free nodes that carry it.
#pragma once

#include "fem/mesh.h"

namespace ligament::fem
{
/// A cell with 2^dim free nodes. Corners that do not hang are their own node and keep their place;
/// in the places of the others stand the masters that are no corners (theory.md eq. (F7)).
template <int dim>
struct CondensedCell
{
  using Shares = Eigen::Matrix<double, n_cell_nodes<dim>, n_cell_nodes<dim>>;

  std::array<int, n_cell_nodes<dim>> nodes; // free nodes of the mesh
  Shares shares = Shares::Identity();       // u(corner a) = sum_b shares(a, b) u(nodes[b])
  Eigen::Matrix<double, dim, n_cell_nodes<dim>> place; // m, of the nodes from cell_lower

  bool is_free_corner(int a) const { return shares(a, a) == 1; }
  bool hangs() const { return !shares.isIdentity(0); }
};

template <int dim>
class CellCondenser
{
public:
  /// The mesh must live as long.
  explicit CellCondenser(const Mesh<dim> &mesh);

  /// Whether any corner of the cell hangs.
  bool hangs(int cell) const;
  CondensedCell<dim> operator()(int cell) const;

private:
  const Mesh<dim> &mesh_;
  std::vector<int> hanging_; // per node: index in the mesh's hanging nodes, or -1
};
} // namespace ligament::fem
