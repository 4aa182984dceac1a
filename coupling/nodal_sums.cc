#include "coupling/nodal_sums.h"

#include "core/check.h"

#include <algorithm>

namespace ligament::coupling
{
template <int dim>
NodalSums<dim>::NodalSums(const std::vector<Cell> &cells, int n_nodes, int n_quantities,
                          const core::Ranks &ranks)
    : ranks_(ranks), n_quantities_(n_quantities)
{
  struct Corner
  {
    const Cell *cell;
    int corner;
  };
  std::vector<std::vector<Corner>> corners(n_nodes);
  for (const Cell &cell : cells)
    for (int a = 0; a < nc; ++a)
      corners[cell.nodes[a]].push_back({&cell, a});

  std::vector<std::size_t> n_entries(ranks.size(), 0);
  struct Entry
  {
    int rank;
    std::size_t number; // of what its rank hands on
  };
  std::vector<Entry> entries;
  begin_ = {0};
  const auto begin_entry = [&](int rank) { entries.push_back({rank, n_entries[rank]++}); };
  const auto add_term = [&](const Corner &c) {
    if (c.cell->rank == ranks.rank())
      terms_.push_back(index(c.cell->batch, 0, 0, c.corner) * lane_array_size + c.cell->lane);
  };
  const auto end_entry = [&](int rank) {
    if (rank == ranks.rank())
      begin_.push_back(terms_.size());
  };
  node_begin_ = {0};
  for (const auto &of_node : corners) {
    const bool is_shared = std::any_of(of_node.begin(), of_node.end(), [&](const Corner &c) {
      return c.cell->rank != of_node.front().cell->rank;
    });
    for (std::size_t k = 0; k < of_node.size(); ++k) {
      const int rank = of_node[k].cell->rank;
      if (k == 0 || is_shared)
        begin_entry(rank);
      add_term(of_node[k]);
      if (k + 1 == of_node.size() || is_shared)
        end_entry(rank);
    }
    node_begin_.push_back(entries.size());
  }
  first_ = {0};
  for (const std::size_t n : n_entries)
    first_.push_back(first_.back() + n);
  for (const Entry &entry : entries)
    entries_.push_back(first_[entry.rank] + entry.number);
}

template <int dim>
void NodalSums<dim>::add(const std::vector<LaneArray> &sums, int first,
                         const std::vector<Nodal<dim> *> &to) const
{
  static_assert(sizeof(LaneArray) == lane_array_size * sizeof(double));
  // As one array of doubles: a term of a later component lies behind the first LaneArray's end.
  const double *from = reinterpret_cast<const double *>(sums.data());
  if (from)
    from += first * dim * stride;
  switch (to.size()) {
  case 1:
    return add_components<dim>(from, to);
  case 2:
    return add_components<2 * dim>(from, to);
  case 3:
    return add_components<3 * dim>(from, to);
  }
  core::require(false, "nodes take up to three sums of their cells at once");
}

template <int dim>
template <int width>
void NodalSums<dim>::add_components(const double *sums, const std::vector<Nodal<dim> *> &to) const
{
  values_.resize(first_.back() * width);
  double *own = values_.data() + first_[ranks_.rank()] * width;
  for (std::size_t e = 0; e + 1 < begin_.size(); ++e, own += width) {
    double sum[width] = {};
    for (std::size_t t = begin_[e]; t < begin_[e + 1]; ++t)
      for (int k = 0; k < width; ++k)
        sum[k] += sums[terms_[t] + k * stride];
    std::copy_n(sum, width, own);
  }
  if (!ranks_.is_one())
    exchange(width);
  std::array<double *, width / dim> nodal;
  for (std::size_t q = 0; q < nodal.size(); ++q)
    nodal[q] = to[q]->data();
  for (std::size_t node = 0; node + 1 < node_begin_.size(); ++node) {
    double sum[width] = {};
    for (std::size_t e = node_begin_[node]; e < node_begin_[node + 1]; ++e)
      for (int k = 0; k < width; ++k)
        sum[k] += values_[entries_[e] * width + k];
    for (int k = 0; k < width; ++k)
      nodal[k / dim][node * dim + k % dim] += sum[k];
  }
}

template <int dim>
void NodalSums<dim>::exchange(std::size_t width) const
{
  std::vector<core::Communicator::Outgoing> out;
  std::vector<core::Communicator::Incoming> in;
  const auto bytes = [&](int r) { return (first_[r + 1] - first_[r]) * width * sizeof(double); };
  for (int r = 0; r < ranks_.size(); ++r) {
    if (r == ranks_.rank())
      continue;
    if (bytes(ranks_.rank()) > 0)
      out.push_back({r, values_.data() + first_[ranks_.rank()] * width, bytes(ranks_.rank())});
    if (bytes(r) > 0)
      in.push_back({r, values_.data() + first_[r] * width, bytes(r)});
  }
  ranks_.exchange(out, in);
}

template class NodalSums<2>;
template class NodalSums<3>;
} // namespace ligament::coupling
