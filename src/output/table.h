// Tables in CSV files with a row of names and a row of units, asked for in SI units.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace ligament::program
{
struct Column
{
  std::string name;
  std::string unit; // "1" for plain numbers
};

/// Whether the writer of a file came to its end. One that was stopped (a kill, a full disk) may
/// have left half a line at the end of the file, without line feed.
enum class TableEnd
{
  whole,
  may_be_torn // what follows the last line feed is left out
};

/// Columns with names and units.
class Table
{
public:
  bool has(const std::string &name) const;
  /// Values in the SI unit asked for ("N", "Pa", "m", "s", "J", "1"); InputError when the column is
  /// missing or its unit is of another kind.
  std::vector<double> column(const std::string &name, const std::string &si_unit) const;
  /// As written, in the column's own unit.
  const std::vector<double> &raw(const std::string &name) const;
  std::size_t n_rows() const { return values_.empty() ? 0 : values_[0].size(); }
  const std::vector<Column> &columns() const { return columns_; }

private:
  friend Table read_csv(const std::string &, TableEnd);
  int find(const std::string &name) const;

  std::string path_;
  std::vector<Column> columns_;
  std::vector<std::vector<double>> values_;
};

/// Reads a CSV file with a row of names and a row of units: history.csv, or a user's curve with
/// load and displacement (or stress and strain). Separators: comma, semicolon or tab; lines that
/// open with # are comments; a byte order mark is passed over. InputError names file, line and
/// column.
Table read_csv(const std::string &path, TableEnd end = TableEnd::whole);

/// Factor from a unit with an optional SI prefix ("kN", "MPa", "us", "mm", "%") to the SI unit
/// asked for; InputError when it is not of that kind.
double unit_factor(const std::string &unit, const std::string &si_unit);
} // namespace ligament::program
