#include "coupling/operators/gap_filter.h"

#include <algorithm>
#include <limits>

namespace ligament::coupling
{
namespace
{
/// From a node to the corner next to it along an axis: the longest edge, because beside cells of
/// twice the size the shorter ones end at hanging nodes.
struct Edge
{
  double length = 0; // m; 0: there is none
  int cell, corner;  // near cell, and the corner at the other end
};

/// Half the distance of a node from the straight line between its neighbours along an axis,
/// [-1 2 -1]/4 where they are equally far; nothing at nodes that lack a neighbour on one side.
template <int dim>
Eigen::SparseMatrix<double, Eigen::RowMajor> second_difference(const Overlap<dim> &overlap,
                                                               int axis)
{
  constexpr int nc = fem::n_cell_nodes<dim>;
  const int n = overlap.n_nodes();
  std::array<std::vector<Edge>, 2> next; // below and above
  next.fill(std::vector<Edge>(n));
  for (std::size_t c = 0; c < overlap.cells.size(); ++c) {
    const auto &cell = overlap.cells[c];
    const double length = overlap.mesh.cell_size[cell.cell][axis];
    for (int a = 0; a < nc; ++a)
      if (Edge &edge = next[a >> axis & 1 ? 0 : 1][cell.nodes[a]];
          cell.shape.is_free_corner(a) && length > edge.length)
        edge = {length, int(c), a ^ (1 << axis)};
  }
  std::vector<Eigen::Triplet<double>> stencil;
  for (int i = 0; i < n; ++i) {
    const Edge &below = next[0][i], &above = next[1][i];
    if (below.length == 0 || above.length == 0)
      continue;
    stencil.emplace_back(i, i, 0.5);
    const auto add = [&](const Edge &edge, double weight) {
      const auto &cell = overlap.cells[edge.cell];
      for (int b = 0; b < nc; ++b)
        if (const double share = cell.shape.shares(edge.corner, b); share > 0)
          stencil.emplace_back(i, cell.nodes[b], -weight * share);
    };
    const double whole = 2 * (below.length + above.length);
    add(below, above.length / whole);
    add(above, below.length / whole);
  }
  Eigen::SparseMatrix<double, Eigen::RowMajor> difference(n, n);
  difference.setFromTriplets(stencil.begin(), stencil.end());
  return difference;
}

/// Smallest edge of the cells around each near node, in m.
template <int dim>
Eigen::VectorXd node_sizes(const Overlap<dim> &overlap)
{
  Eigen::VectorXd size =
      Eigen::VectorXd::Constant(overlap.n_nodes(), std::numeric_limits<double>::max());
  for (const auto &cell : overlap.cells)
    for (const int node : cell.nodes)
      size[node] = std::min(size[node], cell.size);
  return size;
}
} // namespace

template <int dim>
Eigen::SparseMatrix<double> make_gap_filter(const Overlap<dim> &overlap, double strength,
                                            double wave_speed, double step,
                                            const Eigen::VectorXd &mass_bound)
{
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  const int n = overlap.n_nodes();
  const Eigen::ArrayXd rate = dim * strength * wave_speed / node_sizes(overlap).array();
  const Eigen::ArrayXd share = (1 - (-rate * step).exp()) / dim;

  Eigen::SparseMatrix<double> filter(n, n);
  for (int axis = 0; axis < dim; ++axis) {
    const Matrix difference = second_difference(overlap, axis);
    const Matrix l = difference * difference * difference;
    // What the rows would take of every node, in its mass: up to twice the mass is safe.
    Eigen::VectorXd taken = Eigen::VectorXd::Zero(n), weight = Eigen::VectorXd::Zero(n);
    for (int i = 0; i < n; ++i)
      for (Matrix::InnerIterator entry(l, i); entry; ++entry)
        taken[entry.col()] += std::abs(entry.value()) * mass_bound[i] / mass_bound[entry.col()];
    for (int i = 0; i < n; ++i) {
      double most = 1;
      for (Matrix::InnerIterator entry(l, i); entry; ++entry)
        most = std::max(most, taken[entry.col()] / 2);
      weight[i] = share[i] * mass_bound[i] / most;
    }
    filter += Eigen::SparseMatrix<double>(l.transpose() * weight.asDiagonal() * l);
  }
  return filter;
}

template Eigen::SparseMatrix<double> make_gap_filter(const Overlap<2> &, double, double, double,
                                                     const Eigen::VectorXd &);
template Eigen::SparseMatrix<double> make_gap_filter(const Overlap<3> &, double, double, double,
                                                     const Eigen::VectorXd &);
} // namespace ligament::coupling
