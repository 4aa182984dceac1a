#include "coupling/operators/coarse_projection.h"

#include "coupling/algebra/independent_columns.h"

namespace ligament::coupling
{
template <int dim>
CoarseProjection<dim>::CoarseProjection(const Overlap<dim> &overlap,
                                        const std::function<double(const Member &)> &mass,
                                        Solver solver)
    : solver_(make_linear_solver(solver))
{
  const int n = overlap.n_nodes();
  const std::vector<int> order = nodes_along_overlap(overlap);
  std::vector<int> rank(n);
  for (int i = 0; i < n; ++i)
    rank[order[i]] = i;

  std::vector<Eigen::Triplet<double>> entries;
  for (const auto &m : overlap.members)
    if (!m.pad)
      for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
        for (int b = 0; b < fem::n_cell_nodes<dim>; ++b)
          entries.emplace_back(rank[m.nodes[a]], rank[m.nodes[b]],
                               mass(m) * m.value[a] * m.value[b]);
  Eigen::SparseMatrix<double> gram(n, n);
  gram.setFromTriplets(entries.begin(), entries.end());
  const std::vector<char> keep = independent_columns(gram);

  std::vector<int> unknown(n, -1);
  for (int i = 0; i < n; ++i)
    if (keep[i]) {
      unknown[i] = int(nodes_.size());
      nodes_.push_back(order[i]);
    }
  std::vector<Eigen::Triplet<double>> kept;
  for (const auto &e : entries)
    if (keep[e.row()] && keep[e.col()])
      kept.emplace_back(unknown[e.row()], unknown[e.col()], e.value());
  Eigen::SparseMatrix<double> system(nodes_.size(), nodes_.size());
  system.setFromTriplets(kept.begin(), kept.end());
  solver_->factorise(system);
  unknowns_.resize(dim * nodes_.size());
}

template <int dim>
void CoarseProjection<dim>::solve(Nodal<dim> &nodal) const
{
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    for (int c = 0; c < dim; ++c)
      unknowns_[i * dim + c] = nodal(nodes_[i], c);
  solver_->solve(unknowns_.data(), dim);
  nodal.setZero();
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    for (int c = 0; c < dim; ++c)
      nodal(nodes_[i], c) = unknowns_[i * dim + c];
}

template class CoarseProjection<2>;
template class CoarseProjection<3>;
} // namespace ligament::coupling
