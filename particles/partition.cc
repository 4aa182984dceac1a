#include "particles/partition.h"

#include "core/check.h"
#include "particles/block_sum.h"

#include <algorithm>

namespace ligament::particles
{
int Partition::owner(std::int64_t place) const
{
  // The last piece that begins there: those before it at the same place are empty.
  return int(std::upper_bound(cuts.begin(), cuts.end() - 1, place) - cuts.begin()) - 1;
}

Partition make_partition(std::int64_t n, int n_ranks, const std::vector<std::int64_t> &weights)
{
  core::require(n >= 0 && n_ranks > 0, "a body is cut into at least one part");
  const std::int64_t n_blocks = (n + sum_block - 1) / sum_block;
  core::require(weights.empty() || std::int64_t(weights.size()) == n_blocks,
                "a partition needs one weight per block of particles");
  const auto weight = [&](std::int64_t b) { return weights.empty() ? 1 : weights[b]; };
  std::int64_t total = 0;
  for (std::int64_t b = 0; b < n_blocks; ++b) {
    core::require(weight(b) >= 0, "weights of a partition are not below 0");
    total += weight(b);
  }
  // In 128 bits: n_ranks times a sum of measured times may not fit into 64.
  __extension__ using Wide = __int128;
  Partition partition{{0}};
  std::int64_t sum = 0, b = 0;
  for (int r = 1; r < n_ranks; ++r) {
    const Wide share = Wide(total) * r; // times n_ranks, as all here
    const auto miss = [&](std::int64_t s) {
      const Wide by = Wide(s) * n_ranks - share;
      return by < 0 ? -by : by;
    };
    while (b < n_blocks && miss(sum + weight(b)) <= miss(sum))
      sum += weight(b++);
    partition.cuts.push_back(std::min(b * sum_block, n));
  }
  partition.cuts.push_back(n);
  return partition;
}
} // namespace ligament::particles
