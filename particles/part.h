// Which of the particles at hand are a process's own, which it steps and which it sees: ranges in
// the one order of all. A process that has the whole body owns, steps and sees all of them.
#pragma once

#include <algorithm>
#include <vector>

namespace ligament::particles
{
/// Particles [begin, end).
struct ParticleRange
{
  int begin, end;
};
/// Ascending, disjoint.
using ParticleRanges = std::vector<ParticleRange>;

inline int count(const ParticleRanges &ranges)
{
  int n = 0;
  for (const ParticleRange &range : ranges)
    n += range.end - range.begin;
  return n;
}

inline bool contains(const ParticleRanges &ranges, int i)
{
  const auto after = std::upper_bound(ranges.begin(), ranges.end(), i,
                                      [](int k, const ParticleRange &r) { return k < r.begin; });
  return after != ranges.begin() && i < (after - 1)->end;
}

/// What is in both.
inline ParticleRanges intersection(const ParticleRanges &a, const ParticleRanges &b)
{
  ParticleRanges both;
  for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end();) {
    const ParticleRange range = {std::max(i->begin, j->begin), std::min(i->end, j->end)};
    if (range.begin < range.end)
      both.push_back(range);
    i->end < j->end ? ++i : ++j;
  }
  return both;
}

template <typename Visit>
void for_each(const ParticleRanges &ranges, Visit &&visit)
{
  for (const ParticleRange &range : ranges)
    for (int i = range.begin; i < range.end; ++i)
      visit(i);
}

/// What one step passes over: a force sees the pressures of its neighbours, and these the turns of
/// theirs.
struct AwakeRanges
{
  ParticleRanges stepped; // forces, kick, drift
  ParticleRanges pressed; // and those within one bond
  ParticleRanges turned;  // and those within two

  /// n particles, all awake.
  static AwakeRanges of_all(int n) { return {{{0, n}}, {{0, n}}, {{0, n}}}; }

  AwakeRanges within(const AwakeRanges &other) const
  {
    return {intersection(stepped, other.stepped), intersection(pressed, other.pressed),
            intersection(turned, other.turned)};
  }
};

/// Every particle of the body is one part's own: sums, output and decisions go over these. Stepped
/// are these and what a coupler needs of others'.
struct Part : AwakeRanges
{
  ParticleRanges owned;

  static Part whole(int n) { return {AwakeRanges::of_all(n), {{0, n}}}; }
  /// Of n particles at hand.
  bool is_whole(int n) const { return count(owned) == n; }
  /// Whether sums and decisions of this part are about particle i.
  bool owns(int i) const { return contains(owned, i); }
};
} // namespace ligament::particles
