// What compare reads from one side: a run with all its files, or a curve.
#pragma once

#include "src/analysis/history_error.h"
#include "src/output/run_folder.h"
#include "src/output/run_record.h"
#include "src/output/table.h"

#include <optional>
#include <string>
#include <vector>

namespace ligament::program
{
/// A run, or a curve of which nothing else is known.
struct ComparedSide
{
  std::string name;
  std::optional<RunFolder> folder;
  std::optional<RunRecord> record;
  Table curve;
  std::string path = {}; // from the root, without links

  /// A column in that unit; empty without the column or without a number in it.
  std::optional<std::vector<double>> values(const char *column, const char *unit) const;

  /// Row of the largest of `load` before it falls: of a run, which knows when that is, the largest
  /// one up to then.
  std::optional<std::size_t> largest_row(const std::vector<double> &load) const;

  /// Rows of time at which all columns have numbers, with the sum of these; empty without them.
  std::optional<TimeSeries> series(const std::vector<const char *> &columns,
                                   const char *unit) const;
};

/// The folder of a run; InputError when it is none.
ComparedSide read_run(const std::string &path);
/// The folder of a run or a CSV curve with units; InputError when it is neither, or a curve of
/// which no column is known.
ComparedSide read_reference(const std::string &path);

/// Of a column of its curve; empty without the column.
std::optional<std::string> unit_of(const ComparedSide &side, const std::string &column);

/// Columns of the curve that compare does not read.
std::vector<std::string> unknown_columns(const ComparedSide &side);

/// What both sides can be measured by: load over displacement, or stress over strain.
struct Measure
{
  const char *x, *x_unit, *y, *y_unit;
};
constexpr Measure by_stress = {"strain", "1", "stress", "Pa"};
constexpr Measure by_load = {"displacement", "m", "load", "N"};
/// Only drawn.
constexpr Measure load_by_time = {"time", "s", "load", "N"};
constexpr Measure stress_by_time = {"time", "s", "stress", "Pa"};

bool has(const ComparedSide &side, const Measure &measure);

/// Slope between 10 % and 50 % of the peak, see fit_stiffness: Pa by stress, N/m by load.
std::optional<double> stiffness(const ComparedSide &side, const Measure &measure);

/// Largest load in N, or stress in Pa, before it falls.
std::optional<double> largest(const ComparedSide &side, const Measure &measure);
/// The same where it is a peak: a run in which nothing broke has none. Of a curve nothing else is
/// known.
std::optional<double> peak(const ComparedSide &side, const Measure &measure);

/// External work up to the largest load in J: booked by a run, else the area under the curve.
std::optional<double> work_at_largest(const ComparedSide &side);

/// When the crack takes over, in s; empty for runs without a peak: the time up to the load's peak
/// at which the body stores most elastic energy. The grips see their peak later, by the way of a
/// wave from the crack.
std::optional<double> onset_time(const ComparedSide &side);
} // namespace ligament::program
