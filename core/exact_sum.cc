#include "core/exact_sum.h"

#include "core/check.h"

#include <limits>

namespace ligament::core
{
namespace
{
constexpr std::int64_t digit_mask = 0xffffffff;
constexpr std::uint64_t bits_of_infinity = std::uint64_t(0x7ff) << 52;

double from_bits(std::uint64_t bits)
{
  double value;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}
} // namespace

void ExactSum::carry()
{
  std::int64_t over = 0;
  for (int i = 0; i + 1 < n_digits; ++i) {
    const std::int64_t digit = digits_[i] + over;
    digits_[i] = digit & digit_mask;
    over = digit >> 32; // rounds down, also below 0
  }
  digits_.back() += over;
  room_ = terms_between_carries;
}

void ExactSum::add_special(std::uint64_t bits)
{
  if (bits << 12)
    special_ |= not_a_number;
  else
    special_ |= bits >> 63 ? minus_infinity : plus_infinity;
}

void ExactSum::merge(const ExactSum &other)
{
  ExactSum terms = other;
  terms.carry();
  carry();
  for (int i = 0; i < n_digits; ++i)
    digits_[i] += terms.digits_[i];
  carry();
  special_ |= terms.special_;
}

double ExactSum::value() const
{
  if (special_)
    return special_ == plus_infinity    ? std::numeric_limits<double>::infinity()
           : special_ == minus_infinity ? -std::numeric_limits<double>::infinity()
                                        : std::numeric_limits<double>::quiet_NaN();
  ExactSum sum = *this;
  sum.carry();
  const bool negative = sum.digits_.back() < 0;
  if (negative) {
    for (std::int64_t &digit : sum.digits_)
      digit = -digit;
    sum.carry();
  }
  // The last digit may be larger than 32 bits: the sum overflows then anyway.
  if (sum.digits_.back() != 0)
    return negative ? -std::numeric_limits<double>::infinity()
                    : std::numeric_limits<double>::infinity();
  int top = n_digits - 2;
  while (top > 0 && sum.digits_[top] == 0)
    --top;
  const auto digit = [&](int i) { return i < 0 ? 0 : std::uint64_t(sum.digits_[i]); };

  // The first 64 bits from the leading one on; whether anything follows.
  if (digit(top) == 0)
    return 0;
  const int zeros = __builtin_clzll(digit(top)) - 32;
  std::uint64_t head = (digit(top) << 32 | digit(top - 1)) << zeros;
  if (zeros > 0)
    head |= digit(top - 2) >> (32 - zeros);
  bool rest = zeros > 0 ? (digit(top - 2) << zeros & digit_mask) != 0 : digit(top - 2) != 0;
  for (int i = top - 3; i >= 0 && !rest; --i)
    rest = sum.digits_[i] != 0;

  // A double's bits are its exponent and mantissa in a row, so that rounding up carries into the
  // exponent; whole multiples of the smallest number have no hidden bit to take off.
  const int last_place = 32 * top + 31 - zeros - 52; // of the mantissa, in powers of the smallest
  std::uint64_t bits;
  if (last_place <= 0)
    bits = head >> 11 >> -last_place;
  else {
    const std::uint64_t mantissa = head >> 11, below = head & 0x7ff;
    const bool up = below > 0x400 || (below == 0x400 && (rest || (mantissa & 1)));
    bits = (std::uint64_t(last_place) << 52) + mantissa + up;
  }
  if (bits > bits_of_infinity)
    bits = bits_of_infinity;
  return from_bits(bits | std::uint64_t(negative) << 63);
}

std::vector<std::int64_t> ExactSum::words() const
{
  ExactSum sum = *this;
  sum.carry();
  std::vector<std::int64_t> words(sum.digits_.begin(), sum.digits_.end());
  words.push_back(special_);
  return words;
}

ExactSum ExactSum::from_words(const std::vector<std::int64_t> &words)
{
  require(words.size() == n_words, "state: an exact sum with a wrong number of words");
  ExactSum sum;
  for (int i = 0; i < n_digits; ++i)
    sum.digits_[i] = words[i];
  sum.special_ = int(words.back());
  sum.carry(); // words may be sums of several
  return sum;
}
} // namespace ligament::core
