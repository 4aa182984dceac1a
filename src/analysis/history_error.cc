#include "src/analysis/history_error.h"

#include <algorithm>
#include <cmath>

namespace ligament::program
{
std::optional<double> value_at(const TimeSeries &s, double time)
{
  if (s.time.empty() || !(time >= s.time.front() && time <= s.time.back()))
    return {};
  const auto after = std::max<std::ptrdiff_t>(
      std::lower_bound(s.time.begin(), s.time.end(), time) - s.time.begin(), 1);
  if (std::size_t(after) == s.time.size())
    return s.value.front();
  const double share =
      (time - s.time[after - 1]) / std::max(s.time[after] - s.time[after - 1], 1e-300);
  const double value = s.value[after - 1] + share * (s.value[after] - s.value[after - 1]);
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

HistoryError history_error(const TimeSeries &run, const TimeSeries &reference, double until)
{
  std::vector<double> time, difference, value;
  for (std::size_t i = 0; i < reference.time.size() && reference.time[i] <= until; ++i)
    if (const auto a = value_at(run, reference.time[i]); a && std::isfinite(reference.value[i])) {
      time.push_back(reference.time[i]);
      difference.push_back(*a - reference.value[i]);
      value.push_back(reference.value[i]);
    }
  const auto integral = [&](const std::vector<double> &f) {
    double sum = 0;
    for (std::size_t i = 1; i < f.size(); ++i)
      sum += 0.5 * (f[i] * f[i] + f[i - 1] * f[i - 1]) * (time[i] - time[i - 1]);
    return sum;
  };
  const auto largest = [](const std::vector<double> &f) {
    double most = 0;
    for (const double v : f)
      most = std::max(most, std::abs(v));
    return most;
  };
  HistoryError error;
  if (integral(value) > 0)
    error = {std::sqrt(integral(difference) / integral(value)),
             largest(difference) / largest(value)};
  return error;
}
} // namespace ligament::program
