#include "src/output/open_run.h"

#include "core/check.h"
#include "core/tell.h"
#include "src/output/table.h"

#include <fmt/format.h>

#include <filesystem>

namespace ligament::program
{
namespace
{
// A record is of 4 to 20 kB.
constexpr std::size_t reserved_bytes = 1 << 16;

void refuse_what_is_no_run(const RunFolder &folder)
{
  std::error_code error;
  const auto status = std::filesystem::status(folder.path, error);
  if (!std::filesystem::exists(status))
    return;
  core::require(std::filesystem::is_directory(status),
                fmt::format("{} is a file: the results of a run need a folder; give another one "
                            "with --output",
                            folder.path));
  const std::string foreign = folder.foreign_entry();
  core::require(foreign.empty(),
                fmt::format("{} is no folder of a run: \"{}\" is in it; give a new or empty folder "
                            "with --output",
                            folder.path, foreign));
}

/// Rows of results, or checkpoints; a run that was ended from outside its loop does not know its
/// steps.
bool has_taken_steps(const RunFolder &folder)
{
  if (std::filesystem::exists(folder.checkpoints()))
    return true;
  try {
    return std::filesystem::exists(folder.history()) &&
           read_csv(folder.history(), TableEnd::may_be_torn).n_rows() > 0;
  } catch (const core::InputError &) {
    return true;
  }
}

/// False when nothing in it is worth keeping: it failed before its first step.
bool holds_results(const RunFolder &folder)
{
  if (!folder.holds_a_run())
    return false;
  try {
    const RunRecord record = read_run_record(folder.record());
    return record.status != "failed" || record.steps > 0 || has_taken_steps(folder);
  } catch (const core::InputError &) {
    return true; // damaged: for its owner to look at
  }
}

std::string move_aside(const RunFolder &folder)
{
  int n = 1;
  while (std::filesystem::exists(fmt::format("{}.{}", folder.path, n)))
    ++n;
  const std::string kept = fmt::format("{}.{}", folder.path, n);
  std::error_code error;
  std::filesystem::rename(folder.path, kept, error);
  core::require<core::EnvironmentError>(
      !error, fmt::format("{} holds a run and cannot be moved to {}: {}; give another folder with "
                          "--output",
                          folder.path, kept, error.message()));
  return kept;
}
} // namespace

OpenRun::OpenRun(RunFolder folder, const RunRecord &first, std::FILE *messages)
    : folder_(std::move(folder))
{
  refuse_what_is_no_run(folder_);
  folder_.create();
  lock_.emplace(folder_.path, "run");
  if (holds_results(folder_)) {
    const std::string kept = move_aside(folder_);
    core::tell(messages, fmt::format("{} held a run: moved to {}\n", folder_.path, kept));
    folder_.create();
    lock_.reset(); // of the folder that has moved
    std::error_code error;
    std::filesystem::remove(kept + "/lock", error);
    lock_.emplace(folder_.path, "run");
  }
  reserve_.emplace(folder_.record(), reserved_bytes);
  write_run_record(folder_.record(), first);
}

OpenRun::OpenRun(RunFolder folder) : folder_(std::move(folder))
{
  core::require(std::filesystem::is_directory(folder_.path) &&
                    (folder_.holds_a_run() || std::filesystem::exists(folder_.checkpoints())),
                folder_.path + " is not the output folder of a run");
  lock_.emplace(folder_.path, "run");
}

namespace
{
void complete(const RunFolder &folder, RunRecord record, const std::string &status,
              const std::string &reason)
{
  record.status = status;
  record.reason = reason;
  write_run_record(folder.record(), record);
}
} // namespace

void OpenRun::go_on(const RunRecord &first)
{
  folder_.create();
  reserve_.emplace(folder_.record(), reserved_bytes);
  RunRecord record = first;
  try {
    record = read_run_record(folder_.record());
  } catch (const core::InputError &) {
    // The disk lost it.
  }
  complete(folder_, record, first.status, first.reason);
}

void OpenRun::end(const std::string &status, const std::string &reason) noexcept
{
  try {
    // A run that has ended stays so: a signal may come while its report is written.
    if (const RunRecord record = read_run_record(folder_.record()); record.status == "running")
      complete(folder_, record, status, reason);
  } catch (const std::exception &error) {
    core::tell(stderr, fmt::format("warning: the record of the run could not be completed: {}\n",
                                   error.what()));
  }
  reserve_.reset();
}

void end_for_another(const RunFolder &folder, const std::string &status,
                     const std::string &reason) noexcept
{
  try {
    const RunRecord record = read_run_record(folder.record());
    if (record.status == "running")
      complete(folder, record, status, reason);
  } catch (const std::exception &) {
    // Nobody has begun one.
  }
}
} // namespace ligament::program
