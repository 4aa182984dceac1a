#include "md/atom_kernel.h"

#include <algorithm>

namespace ligament::md
{
namespace
{
/// Few enough that the pairs of a block stay in the nearest cache while it is at work.
constexpr int slots_per_block = 32;
constexpr int padding = 16;
} // namespace

AtomKernel::AtomKernel(const Potential &potential)
    : cutoff_(potential.cutoff()), has_embedding_(potential.has_embedding())
{
  if (potential.n_species() > 1)
    return;
  const Spline &pair = potential.pair_spline(0, 0);
  inverse_step_ = 1 / pair.step();
  // One more, of zeros: distances at the cut-off may be rounded into it.
  table_.assign(pair.pieces().size() + 1, PairPiece{});
  for (std::size_t k = 0; k + 1 < table_.size(); ++k)
    for (int c = 0; c < 4; ++c) {
      table_[k].pair[c] = pair.pieces()[k][c];
      if (has_embedding_)
        table_[k].density[c] = potential.density_spline(0, 0).pieces()[k][c];
    }
  if (has_embedding_)
    embedding_ = potential.embedding_spline(0);
}

// A block is due when every F' that its pairs need is known; the density of a block is whole when
// all rows that reach into it have been through the first pass.
void AtomKernel::prepare(const NeighbourList &list)
{
  if (build_ == list.n_builds())
    return;
  build_ = list.n_builds();
  const int n = list.n_atoms(), n_blocks = (n + slots_per_block - 1) / slots_per_block;
  slot_of_image_.clear();
  for (int k = n; k < n + list.n_images(); ++k)
    slot_of_image_.push_back(list.slot_of(k));
  blocks_.clear();
  std::vector<int> whole(n_blocks), due(n_blocks, 0);
  for (int b = 0; b < n_blocks; ++b) {
    blocks_.push_back({b * slots_per_block, std::min(n, (b + 1) * slots_per_block)});
    whole[b] = b;
  }
  const auto for_each_reached = [&](auto &&visit) {
    for (int b = 0; b < n_blocks; ++b)
      for (int k = list.begin()[blocks_[b].first]; k < list.begin()[blocks_[b].last]; ++k)
        visit(b, list.slot_of(list.neighbours()[k]) / slots_per_block);
  };
  for_each_reached([&](int b, int other) { whole[other] = std::max(whole[other], b); });
  for (int b = 0; b < n_blocks; ++b)
    due[b] = whole[b];
  for_each_reached([&](int b, int other) { due[b] = std::max(due[b], whole[other]); });
  whole_after_.assign(n_blocks, {});
  due_after_.assign(n_blocks, {});
  for (int b = 0; b < n_blocks; ++b) {
    whole_after_[whole[b]].push_back(b);
    due_after_[due[b]].push_back(b);
  }
  int most = 0;
  for (const SlotBlock &block : blocks_)
    most = std::max(most, list.begin()[block.last] - list.begin()[block.first]);
  scratch_.resize(5 * (most + 2 * padding) / 4 + 1);
  density_.resize(n);
  slope_.assign(n, 0.);
  force_.resize(n);
  buffer_of_.assign(n_blocks, -1);
}

void AtomKernel::find_slopes(const SlotBlock &block)
{
  if (has_embedding_)
    for (int s = block.first; s < block.last; ++s)
      slope_[s] = embedding_(density_[s]).slope;
}

template <int dim>
void AtomKernel::compute(const NeighbourList &list, Components<dim> &force)
{
  prepare(list);
  std::fill(density_.begin(), density_.end(), 0.);
  std::fill(force_.begin(), force_.end(), AtomRecord{});
  const KernelArrays arrays = {list.records().data(),
                               list.begin().data(),
                               list.neighbours().data(),
                               list.n_images() > 0 ? slot_of_image_.data() : nullptr,
                               list.n_atoms(),
                               table_.data(),
                               cutoff_ * cutoff_,
                               inverse_step_,
                               density_.data(),
                               slope_.data(),
                               force_.data(),
                               component(scratch_[0])};
  const KernelPasses passes = kernel_passes();
  for (int b = 0; b < int(blocks_.size()); ++b) {
    if (free_buffers_.empty()) {
      free_buffers_.push_back(int(buffers_.size()));
      buffers_.emplace_back();
    }
    buffer_of_[b] = free_buffers_.back();
    free_buffers_.pop_back();
    passes.first(arrays, blocks_[b], buffers_[buffer_of_[b]]);
    for (const int w : whole_after_[b])
      find_slopes(blocks_[w]);
    for (const int d : due_after_[b]) {
      passes.second(arrays, blocks_[d], buffers_[buffer_of_[d]]);
      free_buffers_.push_back(buffer_of_[d]);
    }
  }
  for (int s = 0; s < list.n_atoms(); ++s)
    for (int c = 0; c < dim; ++c)
      force[c][list.order()[s]] = component(force_[s])[c];
}

template void AtomKernel::compute<2>(const NeighbourList &, Components<2> &);
template void AtomKernel::compute<3>(const NeighbourList &, Components<3> &);
} // namespace ligament::md
