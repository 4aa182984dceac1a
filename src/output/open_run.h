// The folder of a run under way: nobody else writes there, and its record says how the run ended.
#pragma once

#include "core/disk_reserve.h"
#include "core/folder_lock.h"
#include "src/output/run_folder.h"
#include "src/output/run_record.h"

#include <cstdio>
#include <optional>

namespace ligament::program
{
class OpenRun
{
public:
  /// Makes the folder, locks it, and writes the record with status "running". An older run in it
  /// moves to <folder>.1, .2, ..., which is told to `messages`; one that failed before its first
  /// step makes way. Throws core::InputError for a folder (or file) that holds something else,
  /// core::EnvironmentError when a run is under way there or the disk refuses.
  OpenRun(RunFolder folder, const RunRecord &first, std::FILE *messages);

  /// Locks the folder of an older run. Throws core::InputError where there is none.
  explicit OpenRun(RunFolder folder);
  /// The older run goes on: its record keeps its figures and says that it runs. Where it cannot be
  /// read this one takes its place.
  void go_on(const RunRecord &first);

  const RunFolder &folder() const { return folder_; }

  /// For a run that cannot say so itself: the record keeps its figures. Does not throw.
  void end(const std::string &status, const std::string &reason) noexcept;

private:
  RunFolder folder_;
  std::optional<core::FolderLock> lock_;
  std::optional<core::DiskReserve> reserve_; // of the record, see write_run_record
};
/// The same for a run that another process has open and doesn't come to end: nothing where its
/// record doesn't say that it runs.
void end_for_another(const RunFolder &folder, const std::string &status,
                     const std::string &reason) noexcept;
} // namespace ligament::program
