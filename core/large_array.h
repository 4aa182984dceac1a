// A long array of numbers on large pages of memory.
#pragma once

#include <cstddef>

namespace ligament::core
{
/// Zeros at first. Memory is taken as it is touched; with large pages where the system offers them
/// and they are asked for, so that many streams don't exhaust the processor's page table cache.
class LargeArray
{
public:
  LargeArray() = default;
  /// Throws EnvironmentError when there is no memory.
  LargeArray(std::size_t size, bool large_pages);
  ~LargeArray();
  LargeArray(const LargeArray &) = delete;
  LargeArray &operator=(const LargeArray &) = delete;
  LargeArray(LargeArray &&other) noexcept;
  LargeArray &operator=(LargeArray &&other) noexcept;

  double *data() { return data_; }
  const double *data() const { return data_; }

private:
  void *mapping_ = nullptr;
  std::size_t bytes_ = 0;
  double *data_ = nullptr;
};
} // namespace ligament::core
