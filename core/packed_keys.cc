#include "core/packed_keys.h"

#include "core/check.h"

#include <algorithm>

namespace ligament::core
{
namespace
{
/// Seven bits a byte, the lowest first; the eighth says that more follow.
void put(std::string &bytes, std::uint64_t number)
{
  for (; number >= 128; number >>= 7)
    bytes += char(number | 128);
  bytes += char(number);
}

/// Small numbers of either sign are small: 0, -1, 1, -2, ... Differences may wrap.
std::uint64_t folded(std::uint64_t difference)
{
  return difference << 1 ^ (0 - (difference >> 63));
}

std::uint64_t unfolded(std::uint64_t number)
{
  return number >> 1 ^ (0 - (number & 1));
}

class Bytes
{
public:
  explicit Bytes(std::string_view bytes) : bytes_(bytes) {}

  std::uint64_t take()
  {
    std::uint64_t number = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      require(!bytes_.empty(), "names of rows: too few bytes");
      const std::uint64_t byte = static_cast<unsigned char>(bytes_.front());
      bytes_.remove_prefix(1);
      number |= (byte & 127) << shift;
      if (byte < 128)
        return number;
    }
    throw InputError("names of rows: a number without an end");
  }
  bool empty() const { return bytes_.empty(); }

private:
  std::string_view bytes_;
};

/// Is row k the next of the run that row k - 1 belongs to?
bool continues(const std::vector<std::int64_t> &keys, std::size_t n, std::size_t k)
{
  const auto *row = &keys[k * n], *before = row - n;
  return std::equal(before, before + n - 1, row) &&
         std::uint64_t(row[n - 1]) == std::uint64_t(before[n - 1]) + 1;
}
} // namespace

std::string pack_keys(const std::vector<std::int64_t> &keys, int n_keys)
{
  const std::size_t n = n_keys, n_rows = keys.size() / n;
  std::string bytes;
  std::vector<std::int64_t> last(n, 0);
  for (std::size_t begin = 0, end; begin < n_rows; begin = end) {
    for (end = begin + 1; end < n_rows && continues(keys, n, end);)
      ++end;
    for (std::size_t c = 0; c < n; ++c)
      put(bytes, folded(std::uint64_t(keys[begin * n + c]) - std::uint64_t(last[c])));
    put(bytes, end - begin - 1);
    std::copy_n(&keys[(end - 1) * n], n, last.begin());
  }
  return bytes;
}

std::vector<std::int64_t> unpack_keys(std::string_view packed, int n_keys, std::int64_t n_rows)
{
  Bytes bytes(packed);
  std::vector<std::int64_t> keys;
  keys.reserve(std::size_t(n_rows) * n_keys);
  std::vector<std::int64_t> row(n_keys, 0);
  for (std::uint64_t left = n_rows; left > 0;) {
    for (std::int64_t &key : row)
      key = std::int64_t(std::uint64_t(key) + unfolded(bytes.take()));
    const std::uint64_t more = bytes.take();
    require(more < left, "names of rows: more than there are rows");
    left -= more + 1;
    keys.insert(keys.end(), row.begin(), row.end());
    for (std::uint64_t k = 0; k < more; ++k) {
      row.back() = std::int64_t(std::uint64_t(row.back()) + 1);
      keys.insert(keys.end(), row.begin(), row.end());
    }
  }
  require(bytes.empty(), "names of rows: too many bytes");
  return keys;
}
} // namespace ligament::core
