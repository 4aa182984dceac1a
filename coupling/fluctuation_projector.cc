#include "coupling/fluctuation_projector.h"

#include <algorithm>
#include <numeric>

namespace ligament::coupling
{
namespace
{
// Columns of a Gram matrix that the others span: banded Cholesky that passes over pivots below
// 1e-10 of the largest diagonal entry. The caller's order keeps the band narrow.
std::vector<char> independent_columns(const Eigen::SparseMatrix<double> &gram)
{
  const int n = int(gram.rows());
  int band = 0;
  double largest = 0;
  for (int col = 0; col < n; ++col)
    for (Eigen::SparseMatrix<double>::InnerIterator it(gram, col); it; ++it) {
      band = std::max(band, std::abs(int(it.row()) - col));
      if (it.row() == col)
        largest = std::max(largest, it.value());
    }
  // lower(i, i - j): row i, j <= band columns back.
  Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(band + 1, n); // column i holds row i of L
  std::vector<char> keep(n, 1);
  for (int i = 0; i < n; ++i) {
    Eigen::VectorXd row = Eigen::VectorXd::Zero(band + 1);
    for (Eigen::SparseMatrix<double>::InnerIterator it(gram, i); it && it.row() <= i; ++it)
      row[i - it.row()] = it.value();
    const int first = std::max(0, i - band);
    for (int j = first; j < i; ++j) {
      if (!keep[j]) {
        row[i - j] = 0;
        continue;
      }
      double sum = row[i - j];
      for (int k = std::max(first, j - band); k < j; ++k)
        sum -= row[i - k] * lower(j - k, j);
      row[i - j] = sum / lower(0, j);
    }
    double pivot = row[0];
    for (int j = first; j < i; ++j)
      pivot -= row[i - j] * row[i - j];
    keep[i] = pivot > 1e-10 * largest;
    row[0] = keep[i] ? std::sqrt(pivot) : 0;
    if (!keep[i])
      row.setZero();
    lower.col(i) = row;
  }
  return keep;
}
} // namespace

template <int dim>
FluctuationProjector<dim>::FluctuationProjector(const Overlap<dim> &overlap,
                                                const Transfer<dim> &transfer,
                                                const particles::Particles<dim> &particles,
                                                const std::string &solver)
    : transfer_(transfer), solver_(make_linear_solver(solver))
{
  const int n = overlap.n_nodes();
  // Nodes along the overlap's longest direction first: a narrow band.
  std::vector<int> order(n), rank(n);
  std::iota(order.begin(), order.end(), 0);
  Vector<dim> low = overlap.mesh.nodes[overlap.near_nodes[0]], high = low;
  for (const int node : overlap.near_nodes) {
    low = low.cwiseMin(overlap.mesh.nodes[node]);
    high = high.cwiseMax(overlap.mesh.nodes[node]);
  }
  int axis;
  (high - low).maxCoeff(&axis);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return overlap.mesh.nodes[overlap.near_nodes[a]][axis] <
           overlap.mesh.nodes[overlap.near_nodes[b]][axis];
  });
  for (int i = 0; i < n; ++i)
    rank[order[i]] = i;

  std::vector<Eigen::Triplet<double>> entries;
  for (const auto &m : overlap.members)
    if (!m.pad)
      for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
        for (int b = 0; b < fem::n_cell_nodes<dim>; ++b)
          entries.emplace_back(rank[m.nodes[a]], rank[m.nodes[b]],
                               particles.mass[m.particle] * m.value[a] * m.value[b]);
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
  nodal_.resize(n, dim);
}

template <int dim>
void FluctuationProjector<dim>::project(Components<dim> &w) const
{
  nodal_.setZero();
  transfer_.add_momentum(w, nodal_);
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    for (int c = 0; c < dim; ++c)
      unknowns_[i * dim + c] = nodal_(nodes_[i], c);
  solver_->solve(unknowns_.data(), dim);
  nodal_.setZero();
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    for (int c = 0; c < dim; ++c)
      nodal_(nodes_[i], c) = unknowns_[i * dim + c];
  transfer_.subtract(nodal_, w);
}

template class FluctuationProjector<2>;
template class FluctuationProjector<3>;
} // namespace ligament::coupling
