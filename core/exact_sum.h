// Sums without an order: every term is kept exactly, the sum is rounded once, when it is read.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

namespace ligament::core
{
/// A fixed-point number of 67 digits of 32 bits, which holds every sum of doubles: the last digit
/// has room for 2^70 terms of the largest exponent. Terms in any order, and partial sums merged in
/// any order, give the same bits. The method is that of R. Neal, Fast exact summation using small
/// and large superaccumulators (2015): digits take up carries until there are too many of them.
class ExactSum
{
public:
  static constexpr int n_digits = 67;
  static constexpr int n_words = n_digits + 1;

  void add(double term);
  /// As if all terms of the other sum were added.
  void merge(const ExactSum &other);

  /// The sum, rounded once to the nearest double, ties to even; overflow gives an infinity. An
  /// infinite term gives that infinity, two of different sign or a NaN give a NaN. Zero is +0.
  double value() const;

  /// The same words for the same sum, however it came about; and back. InputError for a wrong
  /// number of words.
  std::vector<std::int64_t> words() const;
  static ExactSum from_words(const std::vector<std::int64_t> &words);

private:
  /// |digit| < 2^32 after carrying; a term adds less than 2^52 to it: 2^11 - 1 are safe.
  static constexpr int terms_between_carries = 1 << 10;

  enum Special
  {
    plus_infinity = 1,
    minus_infinity = 2,
    not_a_number = 4
  };

  /// Brings all digits but the last, which has the sign, to 0 .. 2^32 - 1.
  void carry();
  void add_special(std::uint64_t bits);

  /// Digit i counts 2^(32 i - 1074).
  std::array<std::int64_t, n_digits> digits_ = {};
  int room_ = terms_between_carries; // terms until digits may overflow
  int special_ = 0;                  // what came that is no number
};

inline void ExactSum::add(double term)
{
  std::uint64_t bits;
  std::memcpy(&bits, &term, sizeof(bits));
  const unsigned exponent = unsigned(bits >> 52) & 0x7ff;
  if (__builtin_expect(exponent == 0x7ff, 0)) {
    add_special(bits);
    return;
  }
  if (--room_ == 0)
    carry();
  // Denormal numbers have the exponent of the smallest normal ones, without the hidden bit.
  const unsigned normal = exponent != 0;
  const std::uint64_t mantissa =
      (bits & ((std::uint64_t(1) << 52) - 1)) | (std::uint64_t(normal) << 52);
  const unsigned place = exponent - normal, shift = place & 31;
  const std::int64_t low = std::int64_t((mantissa << shift) & 0xffffffff),
                     high = std::int64_t(mantissa >> (32 - shift)),
                     sign = std::int64_t(bits) >> 63; // 0 or -1
  std::int64_t *digit = &digits_[place >> 5];
  digit[0] += (low ^ sign) - sign;
  digit[1] += (high ^ sign) - sign;
}
} // namespace ligament::core
