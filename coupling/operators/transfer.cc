#include "coupling/operators/transfer.h"

#include <algorithm>
#include <numeric>

namespace ligament::coupling
{
template <int dim>
Transfer<dim>::Transfer(const Overlap<dim> &overlap, const particles::Particles<dim> &particles)
{
  const auto &members = overlap.members;
  std::vector<int> order(members.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return members[a].nodes < members[b].nodes; });
  for (const int index : order) {
    const auto &m = members[index];
    if (groups_.empty() || groups_.back().nodes != m.nodes)
      groups_.push_back({size(), size(), m.nodes});
    ++groups_.back().end;
    particle_.push_back(m.particle);
    for (int a = 0; a < nc; ++a)
      value_[a].push_back(m.value[a]);
    free_.push_back(m.pad ? 0 : 1);
    mass_.push_back(m.pad ? 0 : particles.mass[m.particle]);
    position_.push_back(m.position);
  }
}

template <int dim>
void Transfer<dim>::add_momentum(const Components<dim> &w, Nodal<dim> &nodal) const
{
  for (const auto &group : groups_)
    for (int c = 0; c < dim; ++c) {
      double sum[nc] = {};
      for (int k = group.begin; k < group.end; ++k) {
        const double momentum = mass_[k] * w[c][k];
        for (int a = 0; a < nc; ++a)
          sum[a] += value_[a][k] * momentum;
      }
      for (int a = 0; a < nc; ++a)
        nodal(group.nodes[a], c) += sum[a];
    }
}

template <int dim>
void Transfer<dim>::subtract(const Nodal<dim> &nodal, Components<dim> &w) const
{
  for (const auto &group : groups_)
    for (int c = 0; c < dim; ++c) {
      double at_node[nc];
      for (int a = 0; a < nc; ++a)
        at_node[a] = nodal(group.nodes[a], c);
      for (int k = group.begin; k < group.end; ++k) {
        double v = 0;
        for (int a = 0; a < nc; ++a)
          v += value_[a][k] * at_node[a];
        w[c][k] -= free_[k] * v;
      }
    }
}

template class Transfer<2>;
template class Transfer<3>;
} // namespace ligament::coupling
