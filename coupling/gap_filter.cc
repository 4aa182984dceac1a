#include "coupling/gap_filter.h"

#include <algorithm>
#include <cmath>

namespace ligament::coupling
{
template <int dim>
Eigen::SparseMatrix<double> make_gap_filter(const Overlap<dim> &overlap, double strength,
                                            double wave_speed, double step,
                                            const Eigen::VectorXd &mass_bound)
{
  const int n = overlap.n_nodes();
  int n_layers = 0;
  for (const auto &cell : overlap.cells)
    n_layers = std::max(n_layers, cell.layer);
  const double width = overlap.parameters.length + n_layers * overlap.cell_size;

  Eigen::SparseMatrix<double> filter(n, n);
  for (int axis = 0; axis < dim; ++axis) {
    // Neighbours along the axis, below and above.
    std::array<std::vector<int>, 2> next;
    next.fill(std::vector<int>(n, -1));
    for (const auto &cell : overlap.cells)
      for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
        if (!((a >> axis) & 1)) {
          const int low = cell.nodes[a], high = cell.nodes[a | (1 << axis)];
          next[1][low] = high;
          next[0][high] = low;
        }
    std::vector<Eigen::Triplet<double>> stencil;
    Eigen::VectorXd weight = Eigen::VectorXd::Zero(n);
    for (int i = 0; i < n; ++i) {
      const int below = next[0][i], above = next[1][i];
      if (below < 0 || above < 0 || next[0][below] < 0 || next[1][above] < 0)
        continue;
      stencil.emplace_back(i, next[0][below], 1. / 16);
      stencil.emplace_back(i, below, -4. / 16);
      stencil.emplace_back(i, i, 6. / 16);
      stencil.emplace_back(i, above, -4. / 16);
      stencil.emplace_back(i, next[1][above], 1. / 16);
      const double distance = overlap.distance_to_edge(overlap.mesh.nodes[overlap.near_nodes[i]]);
      const double z = std::clamp((overlap.parameters.length - distance) / width, 0., 1.);
      const double rate = dim * strength * wave_speed / overlap.cell_size * z * z;
      weight[i] = (1 - std::exp(-rate * step)) * mass_bound[i] / dim;
    }
    Eigen::SparseMatrix<double> l(n, n);
    l.setFromTriplets(stencil.begin(), stencil.end());
    filter += Eigen::SparseMatrix<double>(l.transpose() * weight.asDiagonal() * l);
  }
  return filter;
}

template Eigen::SparseMatrix<double> make_gap_filter(const Overlap<2> &, double, double, double,
                                                     const Eigen::VectorXd &);
template Eigen::SparseMatrix<double> make_gap_filter(const Overlap<3> &, double, double, double,
                                                     const Eigen::VectorXd &);
} // namespace ligament::coupling
