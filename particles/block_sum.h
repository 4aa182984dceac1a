// Sums over particles at the price of plain ones, which a cut of the body between blocks keeps.
#pragma once

#include "core/exact_sum.h"
#include "particles/part.h"

#include <algorithm>

namespace ligament::particles
{
/// Particles that are summed as doubles, in their order and counted from the first one; what blocks
/// give is summed exactly. A term of an exact sum per particle takes up to a tenth of a step in 2D.
constexpr int sum_block = 64;

/// For terms that come component by component: `visit` calls add(term) for each, and term(begin,
/// end) is its sum over the particles of a block. Many blocks at a time: memory comes in long runs.
template <typename Visit>
core::ExactSum sum_over_blocks(int n, Visit &&visit)
{
  constexpr int n_blocks = 32;
  core::ExactSum all;
  for (int first = 0; first < n; first += n_blocks * sum_block) {
    double sums[n_blocks] = {};
    visit([&](auto &&term) {
      int begin = first;
      for (int b = 0; b < n_blocks && begin < n; ++b, begin += sum_block)
        sums[b] += term(begin, std::min(begin + sum_block, n));
    });
    for (const double sum : sums)
      all.add(sum);
  }
  return all;
}

/// The same over ranges, each counted from its first particle: parts begin with a block.
template <typename Visit>
core::ExactSum sum_over_blocks(const ParticleRanges &ranges, Visit &&visit)
{
  core::ExactSum all;
  for (const auto &[begin, end] : ranges) {
    const int first = begin;
    all.merge(sum_over_blocks(end - begin, [&](const auto &add) {
      visit([&](auto &&term) {
        add([&](int from, int to) { return term(first + from, first + to); });
      });
    }));
  }
  return all;
}

/// Of term(i), i from 0 to n - 1.
template <typename Term>
core::ExactSum block_sum(int n, Term &&term)
{
  core::ExactSum all;
  for (int begin = 0; begin < n; begin += sum_block) {
    double sum = 0;
    for (int i = begin; i < std::min(begin + sum_block, n); ++i)
      sum += term(i);
    all.add(sum);
  }
  return all;
}
template <typename Term>
core::ExactSum block_sum(const ParticleRanges &ranges, Term &&term)
{
  core::ExactSum all;
  for (const auto &[begin, end] : ranges) {
    const int first = begin;
    all.merge(block_sum(end - begin, [&](int i) { return term(first + i); }));
  }
  return all;
}
} // namespace ligament::particles
