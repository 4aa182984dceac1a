// Internal forces of many linear cells: the far field's hot loop, over plain arrays.
#pragma once

#include "fem/mesh.h"

namespace ligament::fem
{
/// Groups the cells by size, general cells by shape: one stiffness per group. Cells of a group that
/// are neighbours in x and whose nodes are numbered side by side form runs, whose nodes are read
/// and written as whole vectors; all others go in batches of 8 with their nodes listed. General
/// cells with few or none of their shape bring a stiffness each, 8 of them side by side.
template <int dim>
class CellKernel
{
public:
  static constexpr int n_dofs = dim * n_cell_nodes<dim>;
  static constexpr int n_rows = n_cell_nodes<dim> / 2; // node rows along x of a cell

  /// `is_own[cell]` says which cells take part.
  CellKernel(const Mesh<dim> &mesh, const Body<dim> &body, const std::vector<char> &is_own);

  /// force -= K u, hanging nodes not yet condensed; in N. Sums are made in the same order on every
  /// processor.
  void subtract_forces(const Components<dim> &displacement, Components<dim> &force) const;

  /// Largest 2/omega_max of the groups for the density: below it leap-frog is stable, in s.
  double stable_step(double density, double thickness) const;

  int n_groups() const { return int(stiffness_.size()); }
  /// Cells that bring a stiffness each.
  int n_single_cells() const;

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

  struct alignas(64) SingleBatch
  {
    /// Upper triangles in rows of four: see multiply_singles.
    std::array<std::array<double, 8>, n_dofs *(n_dofs + 1) / 2> stiffness;
    int n_cells;
    std::array<std::array<int, 8>, n_cell_nodes<dim>> node;
  };

private:
  /// Appends the group with its runs and batches.
  void add_group(const Mesh<dim> &mesh, const CellMatrix<dim> &k, const std::vector<int> &cells);
  void add_general_cells(const Mesh<dim> &mesh, const Body<dim> &body,
                         const std::vector<char> &is_own);
  void add_single(const std::array<int, n_cell_nodes<dim>> &nodes, const CellMatrix<dim> &k);

  std::vector<Vector<dim>> size_; // m, of the cells of groups of boxes, which come first
  std::vector<std::array<double, n_dofs * n_dofs>> stiffness_; // row by row
  std::vector<Run> runs_;
  std::vector<Batch> batches_;
  std::vector<SingleBatch> singles_;
  double stiffest_ = 0; // Pa/m^2, eigenvalue of K against the shares of volume of general cells
};
} // namespace ligament::fem
