#include "coupling/operators/velocity_constraint.h"

#include "coupling/algebra/independent_columns.h"

#include <cmath>
#include <map>

namespace ligament::coupling
{
namespace
{
using Matrix = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;

/// Phi^T diag(weight) Phi; weight(member) for each member.
template <int dim, typename Weight>
Matrix weighted_gram(const Overlap<dim> &overlap, Weight &&weight)
{
  Triplets entries;
  for (const auto &m : overlap.members)
    for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
      for (int b = 0; b < fem::n_cell_nodes<dim>; ++b)
        entries.emplace_back(m.nodes[a], m.nodes[b], weight(m) * m.value[a] * m.value[b]);
  Matrix gram(overlap.n_nodes(), overlap.n_nodes());
  gram.setFromTriplets(entries.begin(), entries.end());
  return gram;
}

/// [A, B; B^T, -C]
Matrix constrained_matrix(const Matrix &a, const Matrix &b, const Matrix &c)
{
  Triplets entries;
  const int n = int(a.rows());
  const auto put = [&](const Matrix &block, int row, int column, double sign, bool transposed) {
    for (int k = 0; k < block.outerSize(); ++k)
      for (Matrix::InnerIterator it(block, k); it; ++it)
        entries.emplace_back(row + int(transposed ? it.col() : it.row()),
                             column + int(transposed ? it.row() : it.col()), sign * it.value());
  };
  put(a, 0, 0, 1, false);
  put(b, 0, n, 1, false);
  put(b, n, 0, 1, true);
  put(c, n, n, -1, false);
  Matrix whole(n + c.rows(), n + c.rows());
  whole.setFromTriplets(entries.begin(), entries.end());
  return whole;
}

/// Hat functions of edge k h from the overlap's lowest corner on, at the overlap's nodes.
template <int dim>
Matrix coarse_hats(const Overlap<dim> &overlap, int k)
{
  Vector<dim> low = overlap.mesh.nodes[overlap.near_nodes[0]];
  for (int i = 0; i < overlap.n_nodes(); ++i)
    if (overlap.is_overlap_node[i])
      low = low.cwiseMin(overlap.mesh.nodes[overlap.near_nodes[i]]);
  std::map<std::array<int, dim>, int> number;
  Triplets entries;
  for (int i = 0; i < overlap.n_nodes(); ++i) {
    if (!overlap.is_overlap_node[i])
      continue;
    const Vector<dim> x =
        (overlap.mesh.nodes[overlap.near_nodes[i]] - low) / (k * overlap.cell_size);
    for (int corner = 0; corner < fem::n_cell_nodes<dim>; ++corner) {
      std::array<int, dim> index;
      double value = 1;
      for (int c = 0; c < dim; ++c) {
        const double whole = std::floor(x[c] + 1e-9), part = std::max(0., x[c] - whole);
        index[c] = int(whole) + (corner >> c & 1);
        value *= corner >> c & 1 ? part : 1 - part;
      }
      if (value > 1e-9)
        entries.emplace_back(number.emplace(index, int(number.size())).first->second, i, value);
    }
  }
  Matrix hats(int(number.size()), overlap.n_nodes());
  hats.setFromTriplets(entries.begin(), entries.end());
  return hats;
}
} // namespace

template <int dim>
VelocityConstraint<dim>::VelocityConstraint(Scheme scheme, const Overlap<dim> &overlap,
                                            const Transfer<dim> &transfer,
                                            const std::vector<double> &shares, const Matrix &mass,
                                            int multiplier_cells, Solver solver)
    : scheme_(scheme), transfer_(transfer), shares_(shares), solver_(make_linear_solver(solver))
{
  std::vector<double> particle_mass(overlap.member_of_particle.size()), share(particle_mass);
  for (int k = 0; k < transfer.size(); ++k) {
    particle_mass[transfer.particle(k)] = transfer.mass(k);
    share[transfer.particle(k)] = shares[k];
  }
  using Member = typename Overlap<dim>::Member;
  for (auto &component : gap_)
    component.resize(transfer.size());
  nodal_.resize(overlap.n_nodes(), dim);
  if (scheme == Scheme::pointwise) {
    solver_->factorise(mass + weighted_gram(overlap, [&](const Member &m) {
                         return particle_mass[m.particle] * share[m.particle];
                       }));
    return;
  }
  gram_ = weighted_gram(overlap, [&](const Member &m) { return particle_mass[m.particle]; });
  make_tests(overlap, gram_, multiplier_cells);
  const Matrix particles =
      tests_ *
      weighted_gram(
          overlap, [&](const Member &m) { return particle_mass[m.particle] / share[m.particle]; }) *
      Matrix(tests_.transpose());
  const Matrix nodes = gram_ * Matrix(tests_.transpose());
  if (scheme == Scheme::xiao_belytschko_lumped) {
    solver_->factorise(mass);
    // The mass is lumped, so no entry of the matrix is negative and its row sums bound it.
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(tests_.rows());
    Eigen::VectorXd x = nodes * ones;
    solver_->solve(x.data(), 1);
    row_sum_ = particles * ones + nodes.transpose() * x;
  } else
    solver_->factorise_constrained(constrained_matrix(mass, nodes, particles));
}

template <int dim>
void VelocityConstraint<dim>::make_tests(const Overlap<dim> &overlap, const Matrix &gram,
                                         int multiplier_cells)
{
  Triplets entries;
  int n = 0;
  if (multiplier_cells == 1) {
    const std::vector<int> order = nodes_along_overlap(overlap);
    Triplets ordering;
    for (std::size_t i = 0; i < order.size(); ++i)
      ordering.emplace_back(int(i), order[i], 1.);
    tests_.resize(overlap.n_nodes(), overlap.n_nodes());
    tests_.setFromTriplets(ordering.begin(), ordering.end());
  } else
    tests_ = coarse_hats(overlap, multiplier_cells);
  const auto keep = independent_columns(tests_ * gram * Matrix(tests_.transpose()));
  std::vector<int> number(keep.size(), -1);
  for (std::size_t i = 0; i < keep.size(); ++i)
    if (keep[i])
      number[i] = n++;
  for (int k = 0; k < tests_.outerSize(); ++k)
    for (Matrix::InnerIterator it(tests_, k); it; ++it)
      if (number[it.row()] >= 0)
        entries.emplace_back(number[it.row()], int(it.col()), it.value());
  tests_.resize(n, overlap.n_nodes());
  tests_.setFromTriplets(entries.begin(), entries.end());
}

// v += (a m)^-1 m Phi lambda
template <int dim>
void VelocityConstraint<dim>::set_multipliers(Components<dim> &v, const Nodal<dim> &lambda) const
{
  for (auto &component : gap_)
    std::fill(component.begin(), component.end(), 0.);
  transfer_.subtract(-lambda, gap_);
  for (int c = 0; c < dim; ++c)
    for (int k = 0; k < transfer_.size(); ++k)
      v[c][k] += gap_[c][k] / shares_[k];
}

template <int dim>
void VelocityConstraint<dim>::project(Components<dim> &v, Nodal<dim> &nodal) const
{
  const int n = int(nodal.rows());
  gap_ = v;
  transfer_.subtract(nodal, gap_);
  if (scheme_ == Scheme::pointwise) {
    for (auto &component : gap_)
      for (int k = 0; k < transfer_.size(); ++k)
        component[k] *= shares_[k];
    nodal_.setZero();
    transfer_.add_momentum(gap_, nodal_);
    solver_->solve(nodal_.data(), dim);
    nodal += nodal_;
    for (auto &component : v)
      std::fill(component.begin(), component.end(), 0.);
    transfer_.subtract(-nodal, v);
    return;
  }
  nodal_.setZero();
  transfer_.add_momentum(gap_, nodal_);
  const Nodal<dim> gap = tests_ * nodal_;
  if (scheme_ == Scheme::xiao_belytschko_lumped) {
    const Nodal<dim> lambda =
        tests_.transpose() * Nodal<dim>(-(row_sum_.cwiseInverse().asDiagonal() * gap));
    unknowns_ = -(gram_ * lambda);
    solver_->solve(unknowns_.data(), dim);
    nodal += unknowns_;
    set_multipliers(v, lambda);
    return;
  }
  unknowns_.setZero(n + gap.rows(), dim);
  unknowns_.bottomRows(gap.rows()) = gap;
  solver_->solve(unknowns_.data(), dim);
  nodal += unknowns_.topRows(n);
  set_multipliers(v, tests_.transpose() * Nodal<dim>(unknowns_.bottomRows(gap.rows())));
}

template class VelocityConstraint<2>;
template class VelocityConstraint<3>;
} // namespace ligament::coupling
