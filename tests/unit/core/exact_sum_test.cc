// Exact sums against an oracle that adds bit by bit; orders, splits, cancellation, the ends of the
// range of doubles.
#include "core/check.h"
#include "core/exact_sum.h"
#include "core/flush_denormals.h"
#include "core/state.h"
#include "core/sums.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <thread>

namespace
{
using ligament::core::ExactSum;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double largest = std::numeric_limits<double>::max();
constexpr double smallest = std::numeric_limits<double>::denorm_min();

std::uint64_t bits_of(double value)
{
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof(bits));
  return bits;
}

double from_bits(std::uint64_t bits)
{
  double value;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

/// One number per power of two, carried when the sum is read; magnitudes by comparison of places.
class BitSum
{
public:
  void add(double term)
  {
    int exponent;
    const double fraction = std::frexp(std::abs(term), &exponent);
    const auto mantissa = std::uint64_t(std::ldexp(fraction, 53));
    for (int b = 0; b < 53; ++b)
      if (mantissa >> b & 1)
        counts_.at(exponent - 53 + b - lowest) += term < 0 ? -1 : 1;
  }

  double value() const
  {
    std::vector<long> bits = carried(1);
    const bool negative = bits.back() < 0;
    if (negative)
      bits = carried(-1);
    int top = int(bits.size()) - 1;
    while (top >= 0 && bits[top] == 0)
      --top;
    // 53 places, but none below the smallest double.
    const int last = std::max(top - 52, -1074 - lowest);
    double sum = 0;
    for (int b = top; b >= last; --b)
      sum = 2 * sum + double(bits[b]);
    bool above_half = false;
    for (int b = last - 2; b >= 0; --b)
      above_half = above_half || bits[b] != 0;
    if (last > 0 && bits[last - 1] && (above_half || bits[last]))
      sum += 1;
    sum = std::ldexp(sum, last + lowest);
    return negative ? -sum : sum;
  }

private:
  static constexpr int lowest = -1130;

  std::vector<long> carried(int sign) const
  {
    std::vector<long> bits = counts_;
    for (long &bit : bits)
      bit *= sign;
    for (std::size_t b = 0; b + 1 < bits.size(); ++b) {
      const long bit = bits[b] & 1;
      bits[b + 1] += (bits[b] - bit) / 2;
      bits[b] = bit;
    }
    return bits;
  }

  std::vector<long> counts_ = std::vector<long>(2300);
};

/// Any double but infinities and NaN.
double any_double(std::mt19937_64 &random)
{
  while (true) {
    const double value = from_bits(random());
    if (std::isfinite(value))
      return value;
  }
}

/// Of exponents within so many powers of two of 1, either sign.
std::vector<double> terms_within(int powers, int n, std::mt19937_64 &random)
{
  std::uniform_real_distribution<double> mantissa(-1, 1);
  std::uniform_int_distribution<int> exponent(-powers, powers);
  std::vector<double> terms(n);
  for (double &term : terms)
    term = std::ldexp(mantissa(random), exponent(random));
  return terms;
}

ExactSum sum_of(const std::vector<double> &terms)
{
  ExactSum sum;
  for (const double term : terms)
    sum.add(term);
  return sum;
}

TEST(ExactSum, OneTermIsItself)
{
  std::mt19937_64 random(1);
  std::vector<double> terms = {1,         -1,         largest,
                               -largest,  smallest,   -smallest,
                               0x1p-1022, -0x1p-1022, 0x0.fffffffffffffp-1022};
  for (int k = 0; k < 100000; ++k)
    terms.push_back(any_double(random));
  for (int k = 0; k < 10000; ++k) // denormal
    terms.push_back(from_bits(random() & 0x800fffffffffffff));
  for (const double term : terms)
    if (term != 0) {
      ASSERT_EQ(bits_of(sum_of({term}).value()), bits_of(term)) << term;
    }
}

TEST(ExactSum, SumsAreThoseBitByBit)
{
  std::mt19937_64 random(2);
  for (const int powers : {1, 10, 60, 200, 1000})
    for (int k = 0; k < 200; ++k) {
      const auto terms = terms_within(powers, 1 + int(random() % 60), random);
      BitSum oracle;
      for (const double term : terms)
        oracle.add(term);
      ASSERT_EQ(bits_of(sum_of(terms).value()), bits_of(oracle.value())) << powers << " " << k;
    }
  for (int k = 0; k < 500; ++k) {
    // Tiny ones, where the sum may be denormal, and halves of the last place.
    BitSum oracle;
    ExactSum sum;
    for (int j = 0; j < 20; ++j) {
      const double term =
          k % 2 ? std::ldexp(double(random() % 8) - 3.5, -1074 + int(random() % 50) + 1)
                : std::ldexp(double(random() % 3) - 1, 53 * int(random() % 3));
      oracle.add(term);
      sum.add(term);
    }
    ASSERT_EQ(sum.value(), oracle.value()) << k;
  }
}

TEST(ExactSum, OrderAndSplitsDoNotMatter)
{
  std::mt19937_64 random(3);
  std::vector<double> terms = terms_within(300, 20000, random);
  const ExactSum sum = sum_of(terms);
  EXPECT_NE(std::accumulate(terms.begin(), terms.end(), 0.),
            std::accumulate(terms.rbegin(), terms.rend(), 0.)); // a plain one is not
  for (int k = 0; k < 5; ++k) {
    std::shuffle(terms.begin(), terms.end(), random);
    std::vector<ExactSum> parts(7);
    for (const double term : terms)
      parts[random() % parts.size()].add(term);
    ExactSum merged;
    for (const ExactSum &part : parts)
      merged.merge(part);
    EXPECT_EQ(sum_of(terms).words(), sum.words());
    EXPECT_EQ(merged.words(), sum.words());
    EXPECT_EQ(bits_of(merged.value()), bits_of(sum.value()));
  }
}

TEST(ExactSum, NothingIsLostInCancellation)
{
  EXPECT_EQ(sum_of({1e300, 1, -1e300}).value(), 1);
  EXPECT_EQ(sum_of({largest, smallest, -largest}).value(), smallest);
  EXPECT_EQ(sum_of({-largest, -smallest, largest}).value(), -smallest);
  EXPECT_EQ(bits_of(sum_of({1e-320, 5, -1e-320, -5}).value()), bits_of(0.));
  EXPECT_EQ(bits_of(sum_of({-0., -0.}).value()), bits_of(0.));
  EXPECT_EQ(bits_of(ExactSum().value()), bits_of(0.));
}

TEST(ExactSum, TiesGoToEven)
{
  const double ulp = std::numeric_limits<double>::epsilon();
  EXPECT_EQ(sum_of({1, ulp / 2}).value(), 1);
  EXPECT_EQ(sum_of({1 + ulp, ulp / 2}).value(), 1 + 2 * ulp);
  EXPECT_EQ(sum_of({1, ulp / 2, smallest}).value(), 1 + ulp);
  EXPECT_EQ(sum_of({1, ulp / 2, -smallest}).value(), 1);
  EXPECT_EQ(sum_of({-1, -ulp / 2, -smallest}).value(), -1 - ulp);
}

TEST(ExactSum, LargerThanAnyDouble)
{
  EXPECT_EQ(sum_of({largest, largest}).value(), infinity);
  EXPECT_EQ(sum_of({-largest, -largest}).value(), -infinity);
  EXPECT_EQ(sum_of({largest, largest, -largest}).value(), largest);
  const double half_place = std::ldexp(1, 970);
  EXPECT_EQ(sum_of({largest, half_place}).value(), infinity);
  EXPECT_EQ(sum_of({largest, std::nextafter(half_place, 0)}).value(), largest);
  ExactSum sum;
  for (int k = 0; k < 1000000; ++k)
    sum.add(k % 2 ? -largest : largest), sum.add(largest);
  EXPECT_EQ(sum.value(), infinity);
  for (int k = 0; k < 999999; ++k)
    sum.add(-largest);
  EXPECT_EQ(sum.value(), largest);
}

TEST(ExactSum, WhatIsNoNumberWins)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(sum_of({1, infinity, -largest}).value(), infinity);
  EXPECT_EQ(sum_of({-infinity, 1}).value(), -infinity);
  EXPECT_TRUE(std::isnan(sum_of({-infinity, 1, infinity}).value()));
  EXPECT_TRUE(std::isnan(sum_of({1, nan}).value()));
  ExactSum sum = sum_of({1}), part = sum_of({2, -infinity});
  sum.merge(part);
  EXPECT_EQ(sum.value(), -infinity);
  EXPECT_EQ(ExactSum::from_words(sum.words()).value(), -infinity);
}

// Mantissas of ones in all shifts fill the digits fastest.
TEST(ExactSum, CarriesBeforeDigitsOverflow)
{
  constexpr std::int64_t mantissa = (std::int64_t(1) << 53) - 1;
  for (int shift = 0; shift < 32; ++shift) {
    const double term = std::ldexp(double(mantissa), shift);
    ExactSum sum;
    constexpr int n = 300000;
    for (int k = 0; k < n; ++k)
      sum.add(-term);
    EXPECT_EQ(sum.value(), std::ldexp(-std::fma(double(n), 0x1p53, -double(n)), shift));
    for (int k = 0; k < n - 1; ++k)
      sum.add(term);
    EXPECT_EQ(sum.value(), -term);
  }
}

TEST(ExactSum, WordsKeepIt)
{
  std::mt19937_64 random(4);
  const auto terms = terms_within(900, 5000, random);
  ExactSum all = sum_of(terms), kept;
  for (const double term : terms) {
    kept.add(term);
    kept = ExactSum::from_words(kept.words());
  }
  EXPECT_EQ(kept.words(), all.words());
  EXPECT_EQ(all.words().size(), std::size_t(ExactSum::n_words));
  EXPECT_THROW(ExactSum::from_words({1, 2}), ligament::core::InputError);
}

// Two parts of a body keep sums of their own; the tables of both together are those of the whole.
TEST(ExactSum, TablesOfPartsAddUpByWords)
{
  using namespace ligament::core;
  std::mt19937_64 random(5);
  const auto terms = terms_within(40, 3000, random);
  const auto part = [&](std::size_t begin, std::size_t end) {
    return exact_sum(end - begin, [&](std::size_t i) { return terms[begin + i]; });
  };
  State whole, first, second;
  save_sum(whole, "work", part(0, 3000));
  save_sum(first, "work", part(0, 1234));
  save_sum(second, "work", part(1234, 3000));
  EXPECT_EQ(load_sum(whole, "work").words(), sum_of(terms).words());

  std::map<std::int64_t, std::int64_t> words;
  for (const State *state : {&first, &second}) {
    const Table &rows = table(*state, "work");
    for (std::size_t r = 0; r < rows.n_rows(); ++r)
      words[rows.keys()[r]] += rows.integers("word")[r];
  }
  std::vector<std::int64_t> keys, values;
  for (const auto &[key, word] : words) {
    keys.push_back(key);
    values.push_back(word);
  }
  Table rows(keys);
  rows.add("word", values);
  const ExactSum merged = load_sum({{"work", rows}}, "work");
  EXPECT_EQ(merged.words(), sum_of(terms).words());
  EXPECT_EQ(bits_of(merged.value()), bits_of(sum_of(terms).value()));

  State nothing;
  save_sum(nothing, "work", ExactSum());
  EXPECT_EQ(bits_of(load_sum(nothing, "work").value()), bits_of(0.));
  Table wrong({0});
  wrong.add("word", std::vector<std::int64_t>{1});
  EXPECT_THROW(load_sum({{"work", wrong}}, "work"), InputError);
}

TEST(ExactSum, DenormalSumsSurviveWhereTheyAreFlushed)
{
  std::uint64_t bits = 0;
  std::thread([&] {
    ligament::core::flush_denormals();
    ExactSum sum;
    sum.add(from_bits(5));
    sum.add(from_bits(7));
    const double value = sum.value();
    bits = bits_of(value);
  }).join();
  EXPECT_EQ(bits, 12u);
}
} // namespace
