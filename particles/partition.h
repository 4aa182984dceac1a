// How a body is cut for ranks: contiguous pieces of its order, of about equal weight.
#pragma once

#include <cstdint>
#include <vector>

namespace ligament::particles
{
/// The first particle of every rank's piece, and the end: n_ranks + 1 numbers, ascending. A piece
/// may be empty.
struct Partition
{
  std::vector<std::int64_t> cuts;

  int n_ranks() const { return int(cuts.size()) - 1; }
  std::int64_t begin(int rank) const { return cuts[rank]; }
  std::int64_t end(int rank) const { return cuts[rank + 1]; }
  /// Of a particle by its place in the order.
  int owner(std::int64_t place) const;
};

/// Cuts n particles behind whole blocks of `block`, those over which sums run (block_sum.h), so
/// that sums of parts merge into that of the body. Weights, one per block, are integers: prefix
/// sums of them have no order. Empty: all blocks weigh the same. Rank r's piece ends behind the
/// block with which the sum comes nearest to its share (r + 1)/n_ranks of the whole. Throws
/// core::InputError for weights below 0 or of a wrong number.
Partition make_partition(std::int64_t n, int n_ranks,
                         const std::vector<std::int64_t> &weights = {});
} // namespace ligament::particles
