#include "src/output/history.h"

#include "core/check.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ligament::program
{
std::vector<Column> history_columns(int dimension, bool has_phases, bool has_tools)
{
  std::vector<Column> columns = {{"time", "s"},    {"step", "1"},         {"load", "N"},
                                 {"stress", "Pa"}, {"displacement", "m"}, {"strain", "1"}};
  for (const char *energy :
       {"kinetic_discrete", "potential_discrete", "kinetic_far", "potential_far", "blended",
        "impulses", "breaking", "fracture", "friction", "cohesive", "damper_fine", "damper_gap",
        "damping", "absorbed", "regime_change", "external_work", "residual"})
    columns.push_back({energy, "J"});
  if (has_phases)
    columns.insert(columns.end() - 2, {"settled", "J"}); // before external_work and residual
  if (has_tools)
    for (const char *energy : {"tool_kinetic", "tool_contact", "tool_spring", "tool_friction"})
      columns.insert(columns.end() - 2, {energy, "J"});
  columns.push_back({"broken_bonds", "1"});
  columns.push_back({"crack_length", dimension == 2 ? "m" : "m^2"});
  if (has_phases)
    columns.push_back({"static", "1"});
  return columns;
}

Table read_history(const RunFolder &folder, const RunRecord &record)
{
  const bool ended = record.status == "done" || record.status == "stopped";
  return read_csv(folder.history(), ended ? TableEnd::whole : TableEnd::may_be_torn);
}

HistoryWriter::HistoryWriter(const std::string &path, std::vector<Column> columns,
                             int rows_per_flush, bool goes_on)
    : columns_(std::move(columns)), row_(columns_.size(), std::numeric_limits<double>::quiet_NaN()),
      file_(path, goes_on ? core::OutputFile::Mode::append : core::OutputFile::Mode::stream),
      rows_per_flush_(rows_per_flush)
{
  if (goes_on)
    return;
  std::string names, units;
  for (const auto &column : columns_) {
    const char *separator = names.empty() ? "" : ",";
    names += separator + column.name;
    units += separator + column.unit;
  }
  file_.write(names + "\n" + units + "\n");
  file_.flush();
}

void HistoryWriter::set(const std::string &name, double value)
{
  const auto column = std::find_if(columns_.begin(), columns_.end(),
                                   [&](const Column &c) { return c.name == name; });
  core::require(column != columns_.end(), "history has no column '" + name + "'");
  row_[column - columns_.begin()] = value;
}

std::string HistoryWriter::take_row()
{
  std::string line;
  for (double &value : row_) {
    // The shortest digits that give the same number back.
    line += fmt::format("{}{}", line.empty() ? "" : ",", value);
    value = std::numeric_limits<double>::quiet_NaN();
  }
  return line + "\n";
}

void HistoryWriter::end_row()
{
  written_ = take_row();
  file_.write(written_);
  if (++unflushed_ >= rows_per_flush_) {
    file_.flush();
    unflushed_ = 0;
  }
}

void HistoryWriter::end_last_row()
{
  if (const std::string row = take_row(); row != written_)
    file_.write(row);
}
} // namespace ligament::program
