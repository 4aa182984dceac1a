// Items that fall into sets, which only ever grow together.
#pragma once

#include <numeric>
#include <vector>

namespace ligament::program
{
class DisjointSets
{
public:
  /// n sets of one item each, 0 to n - 1.
  explicit DisjointSets(int n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }

  /// A further item, alone in its set; returns its number.
  int add()
  {
    parent_.push_back(int(parent_.size()));
    return parent_.back();
  }

  /// The item that stands for the set of this one.
  int find(int i)
  {
    while (parent_[i] != i)
      i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  /// What stands for j then stands for both.
  void join(int i, int j) { parent_[find(i)] = find(j); }

private:
  std::vector<int> parent_;
};
} // namespace ligament::program
