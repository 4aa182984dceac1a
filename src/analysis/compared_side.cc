#include "src/analysis/compared_side.h"

#include "core/check.h"
#include "core/files.h"
#include "core/parameters/spelling.h"
#include "src/analysis/curve.h"
#include "src/analysis/verdict.h"
#include "src/output/history.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <sstream>

namespace ligament::program
{
namespace
{
/// What a curve can be compared by.
constexpr const char *known_columns[] = {"time",   "load",   "displacement",
                                         "stress", "strain", "external_work"};

std::string name_of(const std::string &path)
{
  auto normal = std::filesystem::path(path).lexically_normal();
  if (!normal.has_filename())
    normal = normal.parent_path();
  std::string name = normal.extension() == ".csv" ? normal.stem() : normal.filename();
  for (char &c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_' && c != '.')
      c = '_';
  return name;
}

std::string place_of(const std::string &path)
{
  std::error_code error;
  auto place = std::filesystem::weakly_canonical(path, error);
  if (!place.has_filename())
    place = place.parent_path();
  return error ? path : place.string();
}

/// Line of the file in which a row of numbers stands, counted as read_csv() does.
int line_of_row(const std::string &path, std::size_t row)
{
  std::istringstream lines(core::read_file(path));
  std::string line;
  std::size_t n_rows = 0; // names and units first
  for (int number = 1; std::getline(lines, line); ++number)
    if (line[0] != '#' && line.find_first_not_of(" \t\r\"") != std::string::npos)
      if (n_rows++ == row + 2)
        return number;
  return 0;
}

/// Which of the two was meant nobody can know.
void refuse_repeated_columns(const ComparedSide &side, const std::string &path)
{
  for (const char *name : known_columns) {
    const auto &columns = side.curve.columns();
    const auto n = std::count_if(columns.begin(), columns.end(),
                                 [name](const Column &c) { return c.name == name; });
    core::require(n < 2,
                  fmt::format("{}: {} columns are named \"{}\": only one of them can be compared; "
                              "rename or remove the others",
                              path, n, name));
  }
}

/// Values between two rows are sought by their times, which has to find them in order.
void refuse_times_that_fall(const ComparedSide &side, const std::string &path)
{
  const auto time = side.values("time", "s");
  if (!time)
    return;
  double before = -HUGE_VAL;
  for (std::size_t row = 0; row < time->size(); ++row) {
    const double now = (*time)[row];
    if (!std::isfinite(now)) // a gap
      continue;
    core::require(now >= before,
                  fmt::format("{}:{}: \"time\" falls from {:g} s to {:g} s: a curve over time has "
                              "one value at each; sort the rows by time, or cut off what was "
                              "measured anew",
                              path, line_of_row(path, row), before, now));
    before = now;
  }
}
} // namespace

ComparedSide read_run(const std::string &path)
{
  ComparedSide side{name_of(path), RunFolder{path}, {}, {}, place_of(path)};
  core::require(side.folder->holds_a_run(),
                path + ": not the output folder of a run (no run.json in it)");
  side.record = read_figures(side.folder->record());
  side.curve = read_history(*side.folder, *side.record);
  return side;
}

ComparedSide read_reference(const std::string &path)
{
  if (std::filesystem::is_directory(path))
    return read_run(path);
  core::require(std::filesystem::is_regular_file(path),
                path + ": neither the output folder of a run nor a CSV file");
  ComparedSide side{name_of(path), {}, {}, read_csv(path), place_of(path)};
  core::require(unknown_columns(side).size() < side.curve.columns().size(),
                path + ": none of its columns is one that compare knows: " +
                    core::listed({std::begin(known_columns), std::end(known_columns)}, "and"));
  core::require(side.values("load", "N") || side.values("stress", "Pa") ||
                    (side.values("time", "s") &&
                     (side.values("displacement", "m") || side.values("external_work", "J"))),
                path + ": it has no numbers to compare; give load (N) or stress (Pa), or time (s) "
                       "beside displacement (m) or external_work (J)");
  refuse_repeated_columns(side, path);
  refuse_times_that_fall(side, path);
  return side;
}

std::optional<std::string> unit_of(const ComparedSide &side, const std::string &column)
{
  for (const Column &c : side.curve.columns())
    if (c.name == column)
      return c.unit;
  return {};
}

std::vector<std::string> unknown_columns(const ComparedSide &side)
{
  std::vector<std::string> unknown;
  for (const Column &column : side.curve.columns())
    if (std::find(std::begin(known_columns), std::end(known_columns), column.name) ==
        std::end(known_columns))
      unknown.push_back(column.name);
  return unknown;
}

std::optional<std::vector<double>> ComparedSide::values(const char *column, const char *unit) const
{
  if (!curve.has(column))
    return {};
  auto numbers = curve.column(column, unit);
  const bool known =
      std::any_of(numbers.begin(), numbers.end(), [](double v) { return std::isfinite(v); });
  return known ? std::optional(std::move(numbers)) : std::nullopt;
}

std::optional<std::size_t> ComparedSide::largest_row(const std::vector<double> &load) const
{
  const auto time = values("time", "s");
  if (!record || !record->largest_time || !time)
    return peak_index(load, values("displacement", "m")
                                .value_or(values("strain", "1").value_or(std::vector<double>())));
  // The load is read between rows, too: the next one may lie behind the fall, as does the row of a
  // break by equilibria.
  const double at = *record->largest_time * (1 + 1e-12);
  std::size_t n_rows = 0;
  while (n_rows < time->size() && (*time)[n_rows] <= at)
    ++n_rows;
  return largest_index(load, n_rows);
}

std::optional<TimeSeries> ComparedSide::series(const std::vector<const char *> &columns,
                                               const char *unit) const
{
  const auto time = values("time", "s");
  std::vector<std::vector<double>> all;
  for (const char *column : columns)
    if (const auto numbers = values(column, unit))
      all.push_back(*numbers);
  if (!time || all.size() != columns.size())
    return {};
  TimeSeries result;
  for (std::size_t i = 0; i < time->size(); ++i) {
    double sum = 0;
    for (const auto &numbers : all)
      sum += numbers[i];
    if (std::isfinite((*time)[i]) && std::isfinite(sum)) {
      result.time.push_back((*time)[i]);
      result.value.push_back(sum);
    }
  }
  return result;
}

namespace
{
/// Leaves out rows of a measured curve in which one of the two is missing.
void keep_whole_rows(std::vector<double> &x, std::vector<double> &y)
{
  std::size_t kept = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (std::isfinite(x[i]) && std::isfinite(y[i])) {
      x[kept] = x[i];
      y[kept++] = y[i];
    }
  x.resize(kept);
  y.resize(kept);
}
} // namespace

bool has(const ComparedSide &side, const Measure &m)
{
  return side.values(m.x, m.x_unit) && side.values(m.y, m.y_unit);
}

std::optional<double> stiffness(const ComparedSide &side, const Measure &m)
{
  if (!has(side, m))
    return {};
  auto x = *side.values(m.x, m.x_unit), y = *side.values(m.y, m.y_unit);
  if (!side.record)
    keep_whole_rows(x, y);
  const auto row = side.record ? side.largest_row(y) : peak_index(y, x);
  return row ? fit_stiffness(x, y, *row) : std::nullopt;
}

std::optional<double> largest(const ComparedSide &side, const Measure &m)
{
  const bool load = std::string(m.y) == "load";
  if (side.record && (load ? side.record->largest_load : side.record->largest_stress))
    return load ? side.record->largest_load : side.record->largest_stress;
  const auto values = side.values(m.y, m.y_unit);
  const auto index = values ? side.largest_row(*values) : std::nullopt;
  return index ? std::optional((*values)[*index]) : std::nullopt;
}

std::optional<double> peak(const ComparedSide &side, const Measure &m)
{
  return side.record && !side.record->peak_load ? std::nullopt : largest(side, m);
}

std::optional<double> work_at_largest(const ComparedSide &side)
{
  const auto load = side.values("load", "N");
  const auto index = load ? side.largest_row(*load) : std::nullopt;
  if (!index)
    return {};
  if (const auto work = side.values("external_work", "J"))
    return std::isfinite((*work)[*index]) ? std::optional((*work)[*index]) : std::nullopt;
  auto x = side.values("displacement", "m");
  if (!x)
    return {};
  std::vector<double> y(load->begin(), load->begin() + std::ptrdiff_t(*index) + 1);
  x->resize(y.size());
  if (!side.record)
    keep_whole_rows(*x, y);
  double area = 0;
  for (std::size_t i = 1; i < y.size(); ++i)
    area += 0.5 * (y[i] + y[i - 1]) * ((*x)[i] - (*x)[i - 1]);
  return area;
}

std::optional<double> onset_time(const ComparedSide &side)
{
  if (side.record && !side.record->peak_load)
    return {};
  const auto time = side.values("time", "s"), load = side.values("load", "N"),
             discrete = side.values("potential_discrete", "J"),
             far = side.values("potential_far", "J"), blended = side.values("blended", "J");
  if (!time || !load || !discrete || !far || !blended)
    return {};
  const auto peak = side.largest_row(*load);
  if (!peak)
    return {};
  std::size_t onset = 0;
  const auto stored = [&](std::size_t i) { return (*discrete)[i] + (*far)[i] + (*blended)[i]; };
  for (std::size_t i = 1; i <= *peak; ++i)
    if (stored(i) > stored(onset))
      onset = i;
  return (*time)[onset];
}

} // namespace ligament::program
