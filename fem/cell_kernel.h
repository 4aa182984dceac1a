// Internal forces of many equal linear cells: the far field's hot loop, over plain arrays.
#pragma once

#include "fem/mesh.h"

namespace ligament::fem
{
/// Groups the cells by size: one stiffness per group. Cells of a group that are neighbours in x and
/// whose nodes are numbered side by side form runs, whose nodes are read and written as whole
/// vectors; all others go in batches of 8 with their nodes listed.
template <int dim>
class CellKernel
{
public:
  static constexpr int n_dofs = dim * n_cell_nodes<dim>;
  static constexpr int n_rows = n_cell_nodes<dim> / 2; // node rows along x of a cell

  /// `is_own[cell]` says which cells take part; thickness in m (2D).
  CellKernel(const Mesh<dim> &mesh, const Stiffness<dim> &c, double thickness,
             const std::vector<char> &is_own);

  /// force -= K u, hanging nodes not yet condensed; in N. Sums are made in the same order on every
  /// processor.
  void subtract_forces(const Components<dim> &displacement, Components<dim> &force) const;

  /// Largest 2/omega_max of the groups for the density: below it leap-frog is stable, in s.
  double stable_step(double density, double thickness) const;

  int n_groups() const { return int(size_.size()); }

  struct Run
  {
    int group, n_cells;
    std::array<int, n_rows> node; // first node of each row; cell k has nodes node + k, node + k + 1
  };

  struct Batch
  {
    int group, n_cells;
    std::array<std::array<int, 8>, n_cell_nodes<dim>> node;
  };

private:
  std::vector<Vector<dim>> size_;                              // m, of a group's cells
  std::vector<std::array<double, n_dofs * n_dofs>> stiffness_; // row by row
  std::vector<Run> runs_;
  std::vector<Batch> batches_;
};
} // namespace ligament::fem
