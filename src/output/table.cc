#include "src/output/table.h"

#include "core/check.h"
#include "core/files.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>

namespace ligament::program
{
namespace
{
std::string trimmed(const std::string &text)
{
  const char *blank = " \t\r\"";
  const auto first = text.find_first_not_of(blank);
  return first == std::string::npos ? ""
                                    : text.substr(first, text.find_last_not_of(blank) - first + 1);
}

std::vector<std::string> split(const std::string &line, char separator)
{
  std::vector<std::string> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(separator, begin), line.size());
    cells.push_back(trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  return cells;
}

/// Independent of the locale; empty cells and "nan" are missing values.
std::optional<double> number(const std::string &cell)
{
  if (cell.empty())
    return std::numeric_limits<double>::quiet_NaN();
  double value;
  const char *begin = cell.data() + (cell[0] == '+'), *end = cell.data() + cell.size();
  const auto result = std::from_chars(begin, end, value);
  return result.ec == std::errc() && result.ptr == end ? std::optional(value) : std::nullopt;
}

char separator_of(const std::string &line)
{
  for (const char candidate : {';', '\t'})
    if (line.find(candidate) != std::string::npos)
      return candidate;
  return ',';
}
} // namespace

double unit_factor(const std::string &unit, const std::string &si_unit)
{
  const std::string plain = si_unit == "1" ? "" : si_unit;
  const std::string given = unit == "1" || unit == "-" ? "" : unit;
  if (given == plain)
    return 1;
  if (plain.empty() && given == "%")
    return 0.01;
  static constexpr std::pair<const char *, double> prefixes[] = {
      {"p", 1e-12}, {"n", 1e-9}, {"u", 1e-6}, {"µ", 1e-6}, {"m", 1e-3},
      {"c", 1e-2},  {"k", 1e3},  {"M", 1e6},  {"G", 1e9},  {"T", 1e12}};
  if (!plain.empty())
    for (const auto &[symbol, factor] : prefixes)
      if (given == symbol + plain)
        return factor;
  throw core::InputError(fmt::format(
      "unit '{}' where '{}' with or without a prefix (k, M, m, u ...) is wanted", unit, si_unit));
}

int Table::find(const std::string &name) const
{
  const auto column = std::find_if(columns_.begin(), columns_.end(),
                                   [&](const Column &c) { return c.name == name; });
  return column == columns_.end() ? -1 : int(column - columns_.begin());
}

bool Table::has(const std::string &name) const
{
  return find(name) >= 0;
}

const std::vector<double> &Table::raw(const std::string &name) const
{
  const int column = find(name);
  if (column < 0) {
    std::string known;
    for (const auto &c : columns_)
      known += " " + c.name;
    throw core::InputError(fmt::format("{}: no column '{}'; there are:{}", path_, name, known));
  }
  return values_[column];
}

std::vector<double> Table::column(const std::string &name, const std::string &si_unit) const
{
  std::vector<double> values = raw(name);
  double factor = 1;
  try {
    factor = unit_factor(columns_[find(name)].unit, si_unit);
  } catch (const core::InputError &error) {
    throw core::InputError(fmt::format("{}: column '{}': {}", path_, name, error.what()));
  }
  if (factor != 1)
    for (double &value : values)
      value *= factor;
  return values;
}

Table read_csv(const std::string &path, TableEnd end_of_table)
{
  std::string text;
  try {
    text = core::read_file(path);
  } catch (const core::EnvironmentError &error) {
    throw core::InputError(error.what());
  }

  if (text.compare(0, 3, "\xEF\xBB\xBF") == 0) // byte order mark
    text.erase(0, 3);
  if (end_of_table == TableEnd::may_be_torn)
    text.resize(text.rfind('\n') + 1); // npos + 1 is 0

  Table table;
  table.path_ = path;
  const auto wrong = [&](int line, const std::string &reason) {
    return core::InputError(fmt::format("{}:{}: {}", path, line, reason));
  };
  char separator = ',';
  enum class Row
  {
    names,
    units,
    values
  } expected = Row::names;

  int line_number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    ++line_number;
    if (trimmed(line).empty() || line[0] == '#')
      continue;
    if (expected == Row::names)
      separator = separator_of(line);
    const auto cells = split(line, separator);
    if (expected == Row::names) {
      for (const auto &name : cells)
        table.columns_.push_back({name, ""});
      table.values_.resize(cells.size());
      expected = Row::units;
      continue;
    }
    if (cells.size() != table.columns_.size())
      throw wrong(line_number, fmt::format("{} cells where the row of names has {}", cells.size(),
                                           table.columns_.size()));
    if (expected == Row::units) {
      // "1" is the unit of plain numbers; any other number says that the row is missing.
      for (std::size_t c = 0; c < cells.size(); ++c)
        if (!cells[c].empty() && cells[c] != "1" && number(cells[c]))
          throw wrong(line_number, "the second row must hold the units, such as 's,kN,mm'");
        else
          table.columns_[c].unit = cells[c].empty() ? "1" : cells[c];
      expected = Row::values;
      continue;
    }
    for (std::size_t c = 0; c < cells.size(); ++c)
      if (const auto value = number(cells[c]))
        table.values_[c].push_back(*value);
      else
        throw wrong(line_number, fmt::format("column '{}': '{}' is not a number{}",
                                             table.columns_[c].name, cells[c],
                                             cells[c].find(',') == std::string::npos
                                                 ? ""
                                                 : "; write decimals with a point"));
  }
  if (expected != Row::values)
    throw wrong(line_number, "a row of names and a row of units are wanted");
  return table;
}
} // namespace ligament::program
