// Names of particles that do not depend on which part of a specimen is packed, a few bytes per row.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace ligament::particles
{
/// Read like an array. Along a row of a lattice the names count up by one: only where they don't,
/// something is stored.
class GlobalIds
{
public:
  /// 0, 1, ..., n - 1.
  explicit GlobalIds(int n = 0) : size_(n), runs_({{0, 0}}) {}
  explicit GlobalIds(const std::vector<std::int64_t> &ids);

  int size() const { return size_; }

  /// Of particle 0 <= i < size().
  std::int64_t operator[](int i) const
  {
    const auto after = std::upper_bound(runs_.begin(), runs_.end(), i,
                                        [](int k, const Run &run) { return k < run.begin; });
    const Run &run = *(after - 1);
    return run.first + (i - run.begin);
  }

  /// All, one by one.
  std::vector<std::int64_t> list() const;

private:
  /// Particles from `begin` on are called `first`, `first` + 1, ...
  struct Run
  {
    int begin;
    std::int64_t first;
  };
  int size_;
  std::vector<Run> runs_;
};

inline GlobalIds::GlobalIds(const std::vector<std::int64_t> &ids) : GlobalIds(int(ids.size()))
{
  runs_.clear();
  for (int i = 0; i < size_; ++i)
    if (i == 0 || ids[i] != ids[i - 1] + 1)
      runs_.push_back({i, ids[i]});
  runs_.shrink_to_fit();
}

inline std::vector<std::int64_t> GlobalIds::list() const
{
  std::vector<std::int64_t> ids(size_);
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const int end = r + 1 < runs_.size() ? runs_[r + 1].begin : size_;
    for (int i = runs_[r].begin; i < end; ++i)
      ids[i] = runs_[r].first + (i - runs_[r].begin);
  }
  return ids;
}
} // namespace ligament::particles
