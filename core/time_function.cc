#include "core/time_function.h"

#include "core/check.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ligament::core
{
namespace
{
constexpr double never = std::numeric_limits<double>::infinity();

bool is_after(double corner, double t)
{
  return corner > t * (1 + 1e-12);
}

template <typename Corners>
double next_of(const Corners &corners, double t)
{
  double next = never;
  for (const double corner : corners)
    if (is_after(corner, t))
      next = std::min(next, corner);
  return next;
}
} // namespace

double Ramp::value(double t) const
{
  if (t <= 0)
    return duration == 0 && t == 0 ? 1. : 0.;
  if (t >= duration)
    return 1;
  const double s = t / duration;
  return s - std::sin(2 * M_PI * s) / (2 * M_PI);
}

double Ramp::integral(double t) const
{
  if (t <= 0)
    return 0;
  if (t >= duration)
    return t - duration / 2;
  const double s = t / duration;
  return duration * (s * s / 2 + (std::cos(2 * M_PI * s) - 1) / (4 * M_PI * M_PI));
}

double Ramp::rate(double t) const
{
  if (t <= 0 || t >= duration)
    return 0;
  return (1 - std::cos(2 * M_PI * t / duration)) / duration;
}

double Ramp::next_corner(double t) const
{
  return is_after(duration, t) ? duration : never;
}

TimeTable::TimeTable(std::vector<std::array<double, 2>> rows) : rows_(std::move(rows))
{
  require(!rows_.empty() && rows_[0][0] >= 0, "a table in time begins at 0 or later");
  integral_.push_back(rows_[0][0] * rows_[0][1]);
  for (std::size_t k = 1; k < rows_.size(); ++k) {
    const double step = rows_[k][0] - rows_[k - 1][0];
    require(step > 0, "the times of a table rise from row to row");
    integral_.push_back(integral_.back() + step * (rows_[k][1] + rows_[k - 1][1]) / 2);
  }
}

int TimeTable::row_at(double t) const
{
  const auto after = std::upper_bound(rows_.begin(), rows_.end(), t,
                                      [](double time, const auto &row) { return time < row[0]; });
  return int(after - rows_.begin()) - 1;
}

double TimeTable::value(double t) const
{
  if (t < 0)
    return 0;
  const int k = row_at(t);
  if (k < 0)
    return rows_.front()[1];
  return k + 1 == int(rows_.size()) ? rows_[k][1] : rows_[k][1] + (t - rows_[k][0]) * rate(t);
}

double TimeTable::integral(double t) const
{
  if (t <= 0)
    return 0;
  const int k = row_at(t);
  return k < 0 ? t * rows_.front()[1]
               : integral_[k] + (t - rows_[k][0]) * (rows_[k][1] + value(t)) / 2;
}

double TimeTable::rate(double t) const
{
  const int k = row_at(t);
  if (t < 0 || k < 0 || k + 1 == int(rows_.size()))
    return 0;
  return (rows_[k + 1][1] - rows_[k][1]) / (rows_[k + 1][0] - rows_[k][0]);
}

double TimeTable::next_corner(double t) const
{
  std::vector<double> corners;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    corners.push_back(rows_[k][0]);
    if (k > 0 && rows_[k][1] * rows_[k - 1][1] < 0)
      corners.push_back(rows_[k - 1][0] - rows_[k - 1][1] * (rows_[k][0] - rows_[k - 1][0]) /
                                              (rows_[k][1] - rows_[k - 1][1]));
  }
  return next_of(corners, t);
}

namespace
{
constexpr double ricker_periods = 3; // of the peak frequency, in the pulse's duration

/// The argument a of the wavelet.
double ricker_place(const Pulse &p, double t)
{
  return M_PI * ricker_periods * ((t - p.start) / p.duration - 0.5);
}
} // namespace

double Pulse::value(double t) const
{
  if (t <= 0 || t <= start || t >= start + duration)
    return 0;
  if (shape == Shape::half_sine)
    return std::sin(M_PI * (t - start) / duration);
  const double a = ricker_place(*this, t);
  return (1 - 2 * a * a) * std::exp(-a * a);
}

double Pulse::integral(double t) const
{
  if (t <= start)
    return 0;
  const double end = std::min(t, start + duration);
  if (shape == Shape::half_sine)
    return duration / M_PI * (1 - std::cos(M_PI * (end - start) / duration));
  const auto primitive = [this](double time) { // of (1 - 2 a^2) exp(-a^2) da
    const double a = ricker_place(*this, time);
    return a * std::exp(-a * a);
  };
  return duration / (M_PI * ricker_periods) * (primitive(end) - primitive(start));
}

double Pulse::rate(double t) const
{
  if (t <= start || t >= start + duration)
    return 0;
  if (shape == Shape::half_sine)
    return M_PI / duration * std::cos(M_PI * (t - start) / duration);
  const double a = ricker_place(*this, t);
  return M_PI * ricker_periods / duration * (4 * a * a - 6) * a * std::exp(-a * a);
}

double Pulse::next_corner(double t) const
{
  const double middle = start + duration / 2;
  if (shape == Shape::half_sine)
    return next_of(std::array{start, middle, start + duration}, t);
  const double zero = std::sqrt(0.5) * duration / (M_PI * ricker_periods),
               trough = std::sqrt(1.5) * duration / (M_PI * ricker_periods);
  return next_of(std::array{start, middle - trough, middle - zero, middle, middle + zero,
                            middle + trough, start + duration},
                 t);
}

double Cycles::value(double t) const
{
  if (t < ramp.duration || t < 0)
    return mean * ramp.value(t);
  return mean + amplitude * std::sin(2 * M_PI * (t - ramp.duration) / period);
}

double Cycles::integral(double t) const
{
  if (t < ramp.duration || t < 0)
    return mean * ramp.integral(t);
  return mean * ramp.integral(t) +
         amplitude * period / (2 * M_PI) * (1 - std::cos(2 * M_PI * (t - ramp.duration) / period));
}

double Cycles::rate(double t) const
{
  if (t < ramp.duration || t < 0)
    return mean * ramp.rate(t);
  return amplitude * 2 * M_PI / period * std::cos(2 * M_PI * (t - ramp.duration) / period);
}

double Cycles::next_corner(double t) const
{
  if (t < ramp.duration && is_after(ramp.duration, t))
    return ramp.duration;
  std::vector<double> phases = {0.25, 0.75};
  if (std::abs(mean) < std::abs(amplitude)) {
    const double zero = std::asin(-mean / amplitude) / (2 * M_PI);
    for (const double phase : {zero, 0.5 - zero})
      phases.push_back(phase - std::floor(phase));
  }
  const double whole = std::max(0., std::floor((t - ramp.duration) / period));
  std::vector<double> corners;
  for (const double cycle : {whole, whole + 1})
    for (const double phase : phases)
      corners.push_back(ramp.duration + (cycle + phase) * period);
  return next_of(corners, t);
}

double TimeFunction::value(double t) const
{
  return std::visit([t](const auto &form) { return form.value(t); }, form_);
}

double TimeFunction::integral(double t) const
{
  return std::visit([t](const auto &form) { return form.integral(t); }, form_);
}

double TimeFunction::rate(double t) const
{
  return std::visit([t](const auto &form) { return form.rate(t); }, form_);
}

double TimeFunction::next_corner(double t) const
{
  return std::visit([t](const auto &form) { return form.next_corner(t); }, form_);
}
} // namespace ligament::core
