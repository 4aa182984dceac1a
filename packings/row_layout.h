// In which order the points of a lattice are numbered: along rows, rows along layers, layers one
// after the other.
#pragma once

#include "packings/lattice.h"

namespace ligament::packings
{
/// The rows of a lattice that meet a box. A row runs along a direction of nearest neighbours; which
/// one, and which rows make a layer, is chosen so that kernels get long rows and small layers: what
/// they keep at hand are three layers.
template <int dim>
class RowLayout
{
public:
  using Index = LatticeIndex<dim>;
  /// Columns: steps from point to point of a row, from row to row, from layer to layer; a basis of
  /// the lattice.
  using Axes = Eigen::Matrix<int, dim, dim>;

  /// Lattice points start, start + step, ... of which there are so many, at least one of them
  /// beyond the box at either end.
  struct Row
  {
    Index start;
    int first; // number of `start` along the row
    int n_points;
  };

  /// Rows along the lattice's own first axis and layers along its last one, unless these have more
  /// than `small_layer` points and in another order they are so much smaller that it pays, shorter
  /// rows counted in; 0: the smallest layers. Throws core::InputError when the box is too large for
  /// the numbers of lattice points.
  RowLayout(const Lattice<dim> &lattice, const Vector<dim> &lower, const Vector<dim> &upper,
            long small_layer);

  const std::vector<Row> &rows() const { return rows_; }
  Index step() const { return axes_.col(0); }
  /// Half of the neighbours, by growing index.
  const std::vector<LatticeNeighbour<dim>> &forward() const { return forward_; }
  /// Most points of a layer (2D: row) that lie in the box.
  long largest_layer() const { return largest_layer_; }

  /// How far apart in rows() two lattice points with this offset lie.
  int row_step(const Index &offset) const
  {
    const Index number = inverse_ * offset;
    return dim == 2 ? number[1] : number[dim - 1] * n_rows_[1] + number[1];
  }

  /// Row of a lattice point and its place there, -1 when no row holds it.
  std::pair<int, int> place(const Index &k) const;

private:
  RowLayout(const Lattice<dim> &lattice, const Vector<dim> &lower, const Vector<dim> &upper,
            const Axes &axes);
  static std::vector<Axes> candidates(const Lattice<dim> &lattice);
  /// Steps of kernels take longer in proportion to this.
  double cost(long small_layer) const;

  Axes axes_, inverse_;
  Index first_row_, n_rows_; // component 0 unused
  std::vector<Row> rows_;
  std::vector<LatticeNeighbour<dim>> forward_;
  long largest_layer_ = 0, n_points_ = 0, n_filled_rows_ = 0; // in the box
};
} // namespace ligament::packings
