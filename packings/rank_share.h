// How ranks divide work on things that all of them have.
#pragma once

#include "core/ranks.h"

#include <utility>

namespace ligament::packings
{
/// Which of n things this rank does: [first, last).
inline std::pair<std::size_t, std::size_t> share_of(std::size_t n, const core::Ranks &ranks)
{
  const auto begin = [&](int rank) { return n * std::size_t(rank) / std::size_t(ranks.size()); };
  return {begin(ranks.rank()), begin(ranks.rank() + 1)};
}
} // namespace ligament::packings
