// What a term of an exact sum costs beside one of a plain sum: {name, value, unit} as JSON lines.
#include "core/exact_sum.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace
{
using ligament::core::ExactSum;

/// ns per term, the least of some repetitions.
template <typename Sum>
double nanoseconds(const std::vector<double> &terms, Sum &&sum)
{
  using Clock = std::chrono::steady_clock;
  double least = std::numeric_limits<double>::infinity(), used = 0;
  for (int k = 0; k < 50; ++k) {
    const auto start = Clock::now();
    used += sum(terms);
    const std::chrono::duration<double, std::nano> time = Clock::now() - start;
    least = std::min(least, time.count() / double(terms.size()));
  }
  return std::isnan(used) ? 0 : least;
}

double plain(const std::vector<double> &terms)
{
  double sum = 0;
  for (const double term : terms)
    sum += term;
  return sum;
}

double exact(const std::vector<double> &terms)
{
  ExactSum sum;
  for (const double term : terms)
    sum.add(term);
  return sum.value();
}

void print(const std::string &name, double value)
{
  fmt::print("{{\"name\": \"{}\", \"value\": {:.3g}, \"unit\": \"ns per term\"}}\n", name, value);
}
} // namespace

int main()
{
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> mantissa(-1, 1);
  const auto draw = [&](int powers) {
    std::uniform_int_distribution<int> exponent(-powers, powers);
    std::vector<double> terms(200000);
    for (double &term : terms)
      term = std::ldexp(mantissa(random), exponent(random));
    return terms;
  };
  const auto near = draw(2), far = draw(100);
  print("plain_sum", nanoseconds(near, plain));
  print("exact_sum_same_size", nanoseconds(near, exact));
  print("exact_sum_200_powers_of_two", nanoseconds(far, exact));
}
