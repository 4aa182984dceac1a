// What the cells of the overlap sum over their members, handed to the near nodes: in one order,
// whichever rank has summed for a cell.
#pragma once

#include "core/ranks.h"
#include "coupling/algebra/lane_array.h"
#include "coupling/overlap.h"

#include <vector>

namespace ligament::coupling
{
/// Every node adds its cells in their order: a rank hands on what it has summed for the nodes whose
/// cells are all its own, and cell by cell what it has for the others (theory.md section 5.7).
template <int dim>
class NodalSums
{
public:
  static constexpr int nc = fem::n_cell_nodes<dim>;

  /// Where the sums of a cell stand: that of quantity q, component c and corner a of the cell in
  /// lane l of batch b is sums[index(b, q, c, a)].value[l].
  struct Cell
  {
    std::array<int, nc> nodes; // near nodes
    int rank;                  // of those that have summed, the one that hands on
    int batch, lane;           // here; of another rank's cells not read
  };

  /// Nothing is handed on.
  NodalSums() = default;
  /// Cells in their order, the same on all ranks but for batch and lane; `n_quantities` vectors are
  /// summed for each node.
  NodalSums(const std::vector<Cell> &cells, int n_nodes, int n_quantities,
            const core::Ranks &ranks);

  std::size_t index(int batch, int quantity, int component, int corner) const
  {
    return ((std::size_t(batch) * n_quantities_ + quantity) * dim + component) * nc + corner;
  }
  /// Entries of the sums of so many batches.
  std::size_t n_sums(std::size_t n_batches) const { return n_batches * n_quantities_ * dim * nc; }

  /// *to[k] += the sums of quantity first + k of all cells.
  void add(const std::vector<LaneArray> &sums, int first,
           const std::vector<Nodal<dim> *> &to) const;

  /// Bytes that one call for so many quantities sends from here to each other rank.
  std::size_t bytes(int n_quantities) const
  {
    return (begin_.empty() ? 0 : begin_.size() - 1) * dim * n_quantities * sizeof(double);
  }

private:
  static constexpr std::size_t stride = nc * lane_array_size; // from one component to the next

  /// add() for `width` components, of all quantities together: they are summed side by side.
  template <int width>
  void add_components(const double *sums, const std::vector<Nodal<dim> *> &to) const;
  void exchange(std::size_t width) const;

  core::Ranks ranks_;
  int n_quantities_ = 0;
  // What this rank hands on: entry k is the sum of terms_[begin_[k]] to terms_[begin_[k + 1]].
  // Terms are places among the doubles of the sums: of a cell's corner, for the first quantity's
  // first component.
  std::vector<std::size_t> terms_, begin_;
  // What all ranks hand on, those of rank r from first_[r] on: node i adds entries_[node_begin_[i]]
  // to entries_[node_begin_[i + 1]].
  std::vector<std::size_t> first_, node_begin_, entries_;
  mutable std::vector<double> values_; // of all entries, dim per quantity
};
} // namespace ligament::coupling
