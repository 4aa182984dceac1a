// Error norms between the histories of two runs: how far apart two curves over time are.
#pragma once

#include <optional>
#include <vector>

namespace ligament::program
{
/// Values over rising times, in SI.
struct TimeSeries
{
  std::vector<double> time, value;
};

/// Relative to the reference: |difference|_2/|value|_2 over time (trapezoids) and largest
/// difference over largest value. Empty without a reference that is not 0.
struct HistoryError
{
  std::optional<double> mean, largest;
};

/// At the times of the reference up to `until` (s) at which the run has values before and after,
/// between which it is taken linear. Rows that are not numbers are left out.
HistoryError history_error(const TimeSeries &run, const TimeSeries &reference, double until);

/// Linear between the rows around `time`; empty outside of them.
std::optional<double> value_at(const TimeSeries &series, double time);
} // namespace ligament::program
