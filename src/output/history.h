// The time series of a run: history.csv with a row of names and a row of units.
#pragma once

#include "core/files.h"
#include "src/output/run_folder.h"
#include "src/output/run_record.h"
#include "src/output/table.h"

#include <string>
#include <vector>

namespace ligament::program
{
/// The columns that every run writes, with their units. Energies in J: kinetic_discrete,
/// potential_discrete, kinetic_far, potential_far, blended, impulses, breaking (the step errors of
/// both), fracture, friction, damper_fine, damper_gap, damping, absorbed, regime_change,
/// external_work, residual. crack_length is in m (2D) or m^2 (3D). `has_phases`: also settled (J)
/// and static, 1 in rows inside a static phase. `has_tools`: also tool_kinetic, tool_contact,
/// tool_spring and tool_friction (J).
std::vector<Column> history_columns(int dimension, bool has_phases = false, bool has_tools = false);

/// history.csv of a run; what one that did not end by itself left in the middle of a line is left
/// out. InputError when it cannot be read.
Table read_history(const RunFolder &folder, const RunRecord &record);

/// Appends rows; a row is on disk after at most `rows_per_flush` rows.
class HistoryWriter
{
public:
  /// With `goes_on` behind the rows that are there.
  HistoryWriter(const std::string &path, std::vector<Column> columns, int rows_per_flush = 50,
                bool goes_on = false);

  /// InputError for a column that was not declared.
  void set(const std::string &name, double value);
  /// Writes the values set since the last row; the others are nan.
  void end_row();
  /// The same, but nothing where it would be the row before again.
  void end_last_row();
  void flush() { file_.flush(); }
  /// All rows are on the disk.
  void sync() { file_.sync(); }

private:
  std::string take_row();

  std::vector<Column> columns_;
  std::vector<double> row_;
  std::string written_; // the row before
  core::OutputFile file_;
  int rows_per_flush_;
  int unflushed_ = 0;
};

} // namespace ligament::program
