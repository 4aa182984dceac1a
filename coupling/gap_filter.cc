#include "coupling/gap_filter.h"

#include <algorithm>
#include <cmath>

namespace ligament::coupling
{
namespace
{
/// [-1 2 -1]/4 along an axis; nothing at nodes that lack a neighbour on one side.
template <int dim>
Eigen::SparseMatrix<double, Eigen::RowMajor> second_difference(const Overlap<dim> &overlap,
                                                               int axis)
{
  const int n = overlap.n_nodes();
  std::array<std::vector<int>, 2> next; // below and above
  next.fill(std::vector<int>(n, -1));
  for (const auto &cell : overlap.cells)
    for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
      if (!((a >> axis) & 1)) {
        const int low = cell.nodes[a], high = cell.nodes[a | (1 << axis)];
        next[1][low] = high;
        next[0][high] = low;
      }
  std::vector<Eigen::Triplet<double>> stencil;
  for (int i = 0; i < n; ++i)
    if (next[0][i] >= 0 && next[1][i] >= 0) {
      stencil.emplace_back(i, next[0][i], -0.25);
      stencil.emplace_back(i, i, 0.5);
      stencil.emplace_back(i, next[1][i], -0.25);
    }
  Eigen::SparseMatrix<double, Eigen::RowMajor> difference(n, n);
  difference.setFromTriplets(stencil.begin(), stencil.end());
  return difference;
}
} // namespace

template <int dim>
Eigen::SparseMatrix<double> make_gap_filter(const Overlap<dim> &overlap, double strength,
                                            double wave_speed, double step,
                                            const Eigen::VectorXd &mass_bound)
{
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  const int n = overlap.n_nodes();
  const double rate = dim * strength * wave_speed / overlap.cell_size;
  const double share = (1 - std::exp(-rate * step)) / dim;

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
      weight[i] = share * mass_bound[i] / most;
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
