#include "coupling/operators/member_terms.h"

#include <algorithm>

namespace ligament::coupling
{
template <int dim>
MemberTerms<dim>::MemberTerms(const Overlap<dim> &overlap,
                              const particles::Particles<dim> &particles,
                              const std::vector<Matrix> &states,
                              const std::vector<InterpolatedMotion<dim>> &motions)
    : overlap_(overlap), particles_(particles), states_(states), motions_(motions)
{
}

template <int dim>
void MemberTerms<dim>::add(const particles::QuadraticTerm<dim> &term)
{
  if (own_.empty()) {
    const std::size_t n = overlap_.members.size();
    own_.assign(n, Matrix::Zero());
    const typename Forces::value_type none = Forces::value_type::Zero(dim, states_.size());
    whole_.assign(n, none);
    shared_.assign(n, none);
    row_.assign(overlap_.n_nodes(), Vector<dim>::Zero());
  }
  const double share = overlap_.subtracted_share(term.location, term.members);
  add_forces(term, share);
  if (share == 0)
    return;
  if (term.members.size() == 2)
    add_pair(term, share);
  else
    add_rows(term, share);
}

// Translations do nothing: the first member stands still.
template <int dim>
void MemberTerms<dim>::add_forces(const particles::QuadraticTerm<dim> &term, double share)
{
  const Vector<dim> origin = get(particles_.reference, term.members[0]);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, Eigen::Dynamic, dim *dim> gradient =
      decltype(gradient)::Zero(term.rows.rows(), states_.size()); // stiffness * row . q
  typename Forces::value_type motion(dim, states_.size());
  for (std::size_t m = 1; m < term.members.size(); ++m) {
    const Vector<dim> r = overlap_.offset(origin, get(particles_.reference, term.members[m]));
    for (std::size_t s = 0; s < states_.size(); ++s)
      motion.col(s) = states_[s] * r;
    gradient += term.rows.template middleCols<dim>(dim * m).lazyProduct(motion);
  }
  gradient = term.stiffness.asDiagonal() * gradient;
  for (std::size_t m = 0; m < term.members.size(); ++m) {
    const int member = overlap_.member_of_particle[term.members[m]];
    if (member < 0)
      continue;
    motion = term.rows.template middleCols<dim>(dim * m).transpose().lazyProduct(gradient);
    whole_[member] -= motion;
    shared_[member] -= share * motion;
  }
}

template <int dim>
void MemberTerms<dim>::add_pair(const particles::QuadraticTerm<dim> &term, double share)
{
  const int i = overlap_.member_of_particle[term.members[0]],
            j = overlap_.member_of_particle[term.members[1]];
  Matrix ii = Matrix::Zero(), ij = Matrix::Zero(), jj = Matrix::Zero();
  for (int q = 0; q < term.rows.rows(); ++q) {
    const Vector<dim> at_i = term.rows.template block<1, dim>(q, 0).transpose(),
                      at_j = term.rows.template block<1, dim>(q, dim).transpose();
    const double k = share * term.stiffness[q];
    ii += k * at_i * at_i.transpose();
    ij += k * at_i * at_j.transpose();
    jj += k * at_j * at_j.transpose();
  }
  own_[i] += ii;
  own_[j] += jj;
  pairs_.push_back({i, j, ij});
}

template <int dim>
void MemberTerms<dim>::add_rows(const particles::QuadraticTerm<dim> &term, double share)
{
  std::vector<int> nodes;
  for (const int i : term.members)
    for (const NodeShare<dim> &s : motions_[overlap_.member_of_particle[i]])
      nodes.push_back(s.node);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  for (int q = 0; q < term.rows.rows(); ++q) {
    for (std::size_t m = 0; m < term.members.size(); ++m) {
      const Vector<dim> at = term.rows.template block<1, dim>(q, dim * m).transpose();
      for (const NodeShare<dim> &s : motions_[overlap_.member_of_particle[term.members[m]]])
        row_[s.node] += s.value * at;
    }
    const int begin = int(node_.size());
    for (const int node : nodes) {
      node_.push_back(node);
      value_.push_back(row_[node]);
      row_[node].setZero();
    }
    rows_.push_back({begin, int(node_.size()), share * term.stiffness[q]});
  }
}

template <int dim>
void MemberTerms<dim>::add_residual(Eigen::MatrixXd &residual) const
{
  const int n = overlap_.n_nodes();
  const auto add = [&](int node, double value, const typename Forces::value_type &force) {
    for (int c = 0; c < dim; ++c)
      residual.row(c * n + node) += value * force.row(c);
  };
  for (std::size_t i = 0; i < whole_.size(); ++i) {
    const auto &m = overlap_.members[i];
    for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
      add(m.nodes[a], m.value[a], whole_[i]);
    for (const NodeShare<dim> &s : motions_[i])
      add(s.node, -s.value, shared_[i]);
  }
}

template <int dim>
auto MemberTerms<dim>::reach_of_nodes() const -> std::vector<std::vector<Reach>>
{
  std::vector<std::vector<Reach>> reach(overlap_.n_nodes());
  for (std::size_t i = 0; i < own_.size(); ++i)
    for (const NodeShare<dim> &s : motions_[i])
      reach[s.node].push_back({int(i), s.value});
  return reach;
}

// Row by row of nodes, so that no pair of nodes is looked up for each term: first how the members
// pull when this node moves, then what that is on the nodes behind it.
template <int dim>
void MemberTerms<dim>::subtract_stiffness(NodalMatrix<dim> &stiffness) const
{
  const int n = overlap_.n_nodes(), n_members = int(own_.size());
  const auto reach = reach_of_nodes();
  std::vector<std::vector<int>> pairs_of(n_members);
  for (int p = 0; p < int(pairs_.size()); ++p) {
    pairs_of[pairs_[p].i].push_back(p);
    pairs_of[pairs_[p].j].push_back(p);
  }
  std::vector<std::vector<std::pair<int, int>>> rows_of(n); // row, and where the node is in it
  for (int r = 0; r < int(rows_.size()); ++r)
    for (int k = rows_[r].begin; k < rows_[r].end; ++k)
      rows_of[node_[k]].emplace_back(r, k);

  std::vector<Matrix> pull(n_members, Matrix::Zero()), sum(n, Matrix::Zero());
  std::vector<char> is_pulled(n_members, false), is_met(n, false);
  std::vector<int> pulled, met;
  const auto pull_at = [&](int member) -> Matrix & {
    if (!is_pulled[member]) {
      is_pulled[member] = true;
      pulled.push_back(member);
    }
    return pull[member];
  };
  const auto sum_at = [&](int node) -> Matrix & {
    if (!is_met[node]) {
      is_met[node] = true;
      met.push_back(node);
    }
    return sum[node];
  };
  for (int a = 0; a < n; ++a) {
    for (const Reach &r : reach[a]) {
      pull_at(r.member) += r.value * own_[r.member];
      for (const int p : pairs_of[r.member]) {
        const Pair &pair = pairs_[p];
        if (pair.i == r.member)
          pull_at(pair.j) += r.value * pair.k;
        else
          pull_at(pair.i) += r.value * pair.k.transpose();
      }
    }
    for (const int member : pulled) {
      for (const NodeShare<dim> &s : motions_[member])
        if (s.node >= a)
          sum_at(s.node) += s.value * pull[member];
      pull[member].setZero();
      is_pulled[member] = false;
    }
    pulled.clear();
    for (const auto &[r, place] : rows_of[a]) {
      const Vector<dim> scaled = rows_[r].stiffness * value_[place];
      for (int k = place; k < rows_[r].end; ++k)
        sum_at(node_[k]) += scaled * value_[k].transpose();
    }
    for (const int b : met) {
      if (a == b)
        sum[b] = ((sum[b] + sum[b].transpose()) / 2).eval();
      stiffness.add_block(a, b, -sum[b]);
      if (a != b)
        stiffness.add_block(b, a, -sum[b].transpose());
      sum[b].setZero();
      is_met[b] = false;
    }
    met.clear();
  }
}

template class MemberTerms<2>;
template class MemberTerms<3>;
} // namespace ligament::coupling
