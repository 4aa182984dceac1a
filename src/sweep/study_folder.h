// The output folder of a study: which of its runs are finished, and for which scene.
#pragma once

#include "core/folder_lock.h"
#include "src/output/run_folder.h"

#include <map>
#include <optional>
#include <string>

namespace ligament::program
{
/// What the sweep measures of a run from outside; written beside it when it ends.
struct RunCost
{
  double core_seconds; // all threads, set-up and output included
  double peak_memory;  // bytes
  int jobs;            // runs at the same time: with more than one, times are not clean
};

/// The state of a study is what lies here: a run counts when it ended by itself, for the scene that
/// it says it computed, whatever its folder's name.
class StudyFolder
{
public:
  /// Makes the folder and locks it against a second sweep until this object ends; reads what is
  /// there. InputError when it holds something else than a study, EnvironmentError when it is
  /// locked or the disk refuses.
  explicit StudyFolder(std::string path);
  const std::string &path() const { return path_; }
  std::string table() const { return path_ + "/sweep.csv"; }
  std::string summary() const { return path_ + "/sweep.html"; }
  /// A file of one case outside of its run: scene, outputs of check and run.
  std::string case_file(const std::string &id, const std::string &name) const;
  /// Where the run of this case is written.
  RunFolder new_run(const std::string &id) const { return {path_ + "/runs/" + id}; }

  /// The finished run with this scene_text(), if there is one.
  std::optional<RunFolder> finished(const std::string &scene) const;
  /// Looks at one folder again.
  void look_at(const RunFolder &run);

private:
  std::string path_;
  std::map<std::string, std::string> finished_; // scene text -> folder
  std::optional<core::FolderLock> lock_;
};

/// The same without lock and without making anything: for listings.
std::map<std::string, std::string> finished_runs(const std::string &study_folder);

void write_cost(const RunFolder &run, const RunCost &cost);
/// Empty when the sweep was killed before it could write it.
std::optional<RunCost> read_cost(const RunFolder &run);
} // namespace ligament::program
