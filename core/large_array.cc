#include "core/large_array.h"

#include "core/check.h"

#include <sys/mman.h>

#include <cstdint>
#include <utility>

namespace ligament::core
{
LargeArray::LargeArray(std::size_t size, bool large_pages)
{
  constexpr std::size_t page = std::size_t(1) << 21;
  bytes_ = size * sizeof(double) + page;
  void *const p = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE,
                       MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (p == MAP_FAILED)
    throw EnvironmentError("not enough memory");
  mapping_ = p;
  const auto address = reinterpret_cast<std::uintptr_t>(p);
  data_ = reinterpret_cast<double *>((address + page - 1) / page * page);
  if (large_pages) // a wish: without them all is slower, not wrong
    madvise(data_, size * sizeof(double), MADV_HUGEPAGE);
}

LargeArray::~LargeArray()
{
  if (mapping_)
    munmap(mapping_, bytes_);
}

LargeArray::LargeArray(LargeArray &&other) noexcept
    : mapping_(std::exchange(other.mapping_, nullptr)), bytes_(other.bytes_),
      data_(std::exchange(other.data_, nullptr))
{
}

LargeArray &LargeArray::operator=(LargeArray &&other) noexcept
{
  std::swap(mapping_, other.mapping_);
  std::swap(bytes_, other.bytes_);
  std::swap(data_, other.data_);
  return *this;
}
} // namespace ligament::core
