#include "md/atom_kernel.h"

#include "core/exact_sum.h"

#include <algorithm>

namespace ligament::md
{
namespace
{
/// Few enough that the pairs of a block stay in the nearest cache while it is at work.
constexpr int slots_per_block = 32;
constexpr int padding = 16;
} // namespace

// Tables of the species that there are, renumbered.
AtomKernel::AtomKernel(const Potential &potential, const std::vector<int> &species)
    : cutoff_(potential.cutoff()), inverse_step_(1 / potential.pair_spline(0, 0).step())
{
  std::vector<int> present = species;
  std::sort(present.begin(), present.end());
  present.erase(std::unique(present.begin(), present.end()), present.end());
  n_species_ = int(present.size());
  for (const int a : present) {
    for (const int b : present) {
      const auto pieces = make_pair_table(potential, a, b);
      table_.insert(table_.end(), pieces.begin(), pieces.end());
    }
    if (potential.has_embedding())
      embedding_.push_back(potential.embedding_spline(a));
  }
  if (n_species_ > 1)
    for (const int a : species)
      species_.push_back(
          int(std::lower_bound(present.begin(), present.end(), a) - present.begin()));
}

void AtomKernel::prepare(const NeighbourList &list)
{
  if (build_ == list.n_builds())
    return;
  build_ = list.n_builds();
  const int n = list.n_atoms(), n_blocks = (n + slots_per_block - 1) / slots_per_block;
  slot_of_image_.clear();
  images_.clear();
  image_begin_.assign(n_blocks + 1, 0);
  for (int k = 0; k < list.n_images(); ++k) {
    slot_of_image_.push_back(list.slot_of(n + k));
    images_.push_back(k);
    ++image_begin_[slot_of_image_.back() / slots_per_block + 1];
  }
  for (int b = 0; b < n_blocks; ++b)
    image_begin_[b + 1] += image_begin_[b];
  std::stable_sort(images_.begin(), images_.end(), [&](int a, int b) {
    return slot_of_image_[a] / slots_per_block < slot_of_image_[b] / slots_per_block;
  });
  blocks_.clear();
  int most = 0;
  for (int b = 0; b < n_blocks; ++b) {
    blocks_.push_back({b * slots_per_block, std::min(n, (b + 1) * slots_per_block)});
    most = std::max(most, list.begin()[blocks_[b].last] - list.begin()[blocks_[b].first]);
  }
  schedule_ = PassSchedule(n_blocks, [&](auto &&visit) {
    for (int b = 0; b < n_blocks; ++b)
      for (int k = list.begin()[blocks_[b].first]; k < list.begin()[blocks_[b].last]; ++k)
        visit(b, list.slot_of(list.neighbours()[k]) / slots_per_block);
  });
  const int size = int(table_.size()) / (n_species_ * n_species_);
  row_.clear();
  column_.clear();
  for (int s = 0; s < n && n_species_ > 1; ++s) {
    column_.push_back(species_[list.order()[s]] * size);
    row_.push_back(column_.back() * n_species_);
  }
  scratch_.resize(5 * (most + 2 * padding) / 4 + 1);
  density_.resize(n);
  force_.resize(n);
}

KernelArrays AtomKernel::arrays(const NeighbourList &list)
{
  prepare(list);
  std::fill(density_.begin(), density_.end(), 0.);
  return {list.records().data(),
          list.begin().data(),
          list.neighbours().data(),
          list.n_images() > 0 ? slot_of_image_.data() : nullptr,
          list.n_atoms(),
          table_.data(),
          n_species_ > 1 ? row_.data() : nullptr,
          n_species_ > 1 ? column_.data() : nullptr,
          cutoff_ * cutoff_,
          inverse_step_,
          density_.data(),
          force_.data(),
          component(scratch_[0])};
}

PairBuffer &AtomKernel::buffer(int number)
{
  if (number >= int(buffers_.size()))
    buffers_.resize(number + 1);
  return buffers_[number];
}

template <int dim>
void AtomKernel::compute(NeighbourList &list, Components<dim> &force)
{
  const KernelArrays k = arrays(list);
  std::fill(force_.begin(), force_.end(), AtomRecord{});
  const KernelPasses passes = kernel_passes();
  const auto find_slopes = [&](int b) {
    if (embedding_.empty())
      return;
    for (int s = blocks_[b].first; s < blocks_[b].last; ++s)
      list.set_extra(s, -inverse_step_ * embedding_of(list, s)(density_[s]).slope);
    for (int m = image_begin_[b]; m < image_begin_[b + 1]; ++m)
      list.set_extra(list.n_atoms() + images_[m], list.records()[slot_of_image_[images_[m]]].extra);
  };
  schedule_.run([&](int b, int number) { passes.first(k, blocks_[b], buffer(number)); },
                find_slopes,
                [&](int b, int number) { passes.second(k, blocks_[b], buffer(number)); });
  for (int s = 0; s < list.n_atoms(); ++s)
    for (int c = 0; c < dim; ++c)
      force[c][list.order()[s]] = component(force_[s])[c];
}

double AtomKernel::energy(const NeighbourList &list)
{
  const KernelArrays k = arrays(list);
  const KernelPasses passes = kernel_passes();
  core::ExactSum sum;
  for (const SlotBlock &block : blocks_) {
    passes.energies(k, block, buffer(0));
    sum.add(buffer(0).energy);
  }
  for (int s = 0; s < list.n_atoms() && !embedding_.empty(); ++s)
    sum.add(embedding_of(list, s)(density_[s]).value);
  return sum.value();
}

template void AtomKernel::compute<2>(NeighbourList &, Components<2> &);
template void AtomKernel::compute<3>(NeighbourList &, Components<3> &);
} // namespace ligament::md
