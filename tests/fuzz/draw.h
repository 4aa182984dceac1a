// Random choices that follow from one seed, on every machine alike.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace ligament::fuzz
{
class Draw
{
public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}

  /// 0 to n - 1; n must be positive.
  std::size_t below(std::size_t n) { return engine_() % n; }
  /// low to high, both possible.
  int between(int low, int high) { return low + int(below(std::size_t(high - low) + 1)); }
  /// True once in n times.
  bool once_in(std::size_t n) { return below(n) == 0; }
  /// In [0, 1).
  double fraction() { return double(engine_() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * fraction(); }
  /// The logarithm is uniform; both bounds must be positive.
  double spread(double low, double high);

  template <typename T>
  const T &of(const std::vector<T> &list)
  {
    return list[below(list.size())];
  }

private:
  // The distributions of the standard library differ between its makers, the engine doesn't.
  std::mt19937_64 engine_;
};

/// A number as somebody writes it who wants to break a reader: huge, tiny, negative, zero, at the
/// ends of the types, words for what is no number, other bases and separators.
std::string odd_number(Draw &draw);

/// A word likewise: empty, with blanks, quotes, brackets, line ends, letters beyond ASCII.
std::string odd_word(Draw &draw);

/// Bytes that are not UTF-8: lone tails, overlong forms, surrogates, cut sequences.
std::string wrong_bytes(Draw &draw);
} // namespace ligament::fuzz
