// When blocks of atoms go through the two passes of embedded atoms, so that little lies between.
#pragma once

#include <algorithm>
#include <vector>

namespace ligament::md
{
/// The first pass of a block adds to the densities of the blocks it reaches; the second one needs
/// their F'. A block is whole when all that reach it have been through the first pass, and due for
/// the second when all that it reaches are whole.
class PassSchedule
{
public:
  PassSchedule() = default;
  /// for_each_reached(visit) calls visit(block, other) for what every block reaches.
  template <typename ForEachReached>
  PassSchedule(int n_blocks, ForEachReached &&for_each_reached);

  /// first(block, buffer), then whole(block), then second(block, buffer); buffers are numbers from
  /// 0 on, one for each block that is between the passes.
  template <typename First, typename Whole, typename Second>
  void run(First &&first, Whole &&whole, Second &&second);

private:
  std::vector<std::vector<int>> whole_after_, due_after_;
  std::vector<int> buffer_of_, free_buffers_;
  int n_buffers_ = 0;
};

template <typename ForEachReached>
PassSchedule::PassSchedule(int n_blocks, ForEachReached &&for_each_reached)
    : whole_after_(n_blocks), due_after_(n_blocks), buffer_of_(n_blocks, -1)
{
  std::vector<int> whole(n_blocks);
  for (int b = 0; b < n_blocks; ++b)
    whole[b] = b;
  for_each_reached([&](int b, int other) { whole[other] = std::max(whole[other], b); });
  std::vector<int> due = whole;
  for_each_reached([&](int b, int other) { due[b] = std::max(due[b], whole[other]); });
  for (int b = 0; b < n_blocks; ++b) {
    whole_after_[whole[b]].push_back(b);
    due_after_[due[b]].push_back(b);
  }
}

template <typename First, typename Whole, typename Second>
void PassSchedule::run(First &&first, Whole &&whole, Second &&second)
{
  for (int b = 0; b < int(buffer_of_.size()); ++b) {
    if (free_buffers_.empty())
      free_buffers_.push_back(n_buffers_++);
    buffer_of_[b] = free_buffers_.back();
    free_buffers_.pop_back();
    first(b, buffer_of_[b]);
    for (const int w : whole_after_[b])
      whole(w);
    for (const int d : due_after_[b]) {
      second(d, buffer_of_[d]);
      free_buffers_.push_back(buffer_of_[d]);
    }
  }
}
} // namespace ligament::md
