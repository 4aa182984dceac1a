#include "src/sweep/study_folder.h"

#include "core/check.h"
#include "core/files.h"
#include "src/output/run_record.h"
#include "src/sweep/cases.h"

#include <filesystem>

namespace ligament::program
{
namespace
{
using Json = nlohmann::ordered_json;

/// Whether one of the files that the scene names has changed since the run began: its text does not
/// say so.
bool names_newer_files(const Json &scene, const RunFolder &run)
{
  std::error_code none;
  const auto begun = std::filesystem::last_write_time(run.resolved_scene(), none);
  for (const char *key : {"/discrete_zone/packing_file", "/specimen/file", "/atoms/file"}) {
    const Json::json_pointer pointer(key);
    if (!scene.contains(pointer) || !scene.at(pointer).is_string())
      continue;
    const auto changed =
        std::filesystem::last_write_time(scene.at(pointer).get<std::string>(), none);
    if (!none && changed > begun)
      return true;
  }
  return false;
}

/// Text of the scene when the run ended by itself.
std::optional<std::string> finished_scene(const RunFolder &run)
{
  if (!run.holds_a_run() || !std::filesystem::exists(run.resolved_scene()))
    return {};
  try {
    const RunRecord record = read_run_record(run.record());
    if (record.status != "done" && record.status != "stopped")
      return {};
    const Json scene = Json::parse(core::read_file(run.resolved_scene()));
    if (names_newer_files(scene, run))
      return {};
    return scene_text(scene);
  } catch (const core::InputError &) {
    return {}; // damaged: the run is done again, this folder is kept
  } catch (const Json::exception &) {
    return {};
  }
}

std::string cost_file(const RunFolder &run)
{
  return run.path + "/cost.json";
}
} // namespace

std::map<std::string, std::string> finished_runs(const std::string &study_folder)
{
  std::map<std::string, std::string> finished;
  std::error_code none;
  for (const auto &entry : std::filesystem::directory_iterator(study_folder + "/runs", none))
    if (const auto scene = finished_scene({entry.path()}))
      finished.emplace(*scene, entry.path());
  return finished;
}

StudyFolder::StudyFolder(std::string path) : path_(std::move(path))
{
  namespace fs = std::filesystem;
  std::error_code error;
  const auto status = fs::status(path_, error);
  const bool is_study = fs::is_directory(path_ + "/runs", error);
  core::require(!fs::exists(status) || is_study ||
                    (fs::is_directory(status) && fs::is_empty(path_, error)),
                path_ + " holds no study: give a new or empty folder with --output");
  make_folder(path_ + "/runs");
  make_folder(path_ + "/cases");
  lock_.emplace(path_, "sweep");
  finished_ = finished_runs(path_);
}

std::string StudyFolder::case_file(const std::string &id, const std::string &name) const
{
  const std::string folder = path_ + "/cases/" + id;
  std::filesystem::create_directories(folder);
  return folder + "/" + name;
}

std::optional<RunFolder> StudyFolder::finished(const std::string &scene) const
{
  const auto found = finished_.find(scene);
  return found == finished_.end() ? std::nullopt : std::optional(RunFolder{found->second});
}

void StudyFolder::look_at(const RunFolder &run)
{
  if (const auto scene = finished_scene(run))
    finished_.emplace(*scene, run.path);
}

void write_cost(const RunFolder &run, const RunCost &cost)
{
  const Json json = {{"core_seconds", cost.core_seconds},
                     {"peak_memory_bytes", cost.peak_memory},
                     {"jobs", cost.jobs}};
  core::write_file(cost_file(run), json.dump(2) + "\n");
}

std::optional<RunCost> read_cost(const RunFolder &run)
{
  try {
    const Json json = Json::parse(core::read_file(cost_file(run)));
    return RunCost{json.at("core_seconds"), json.at("peak_memory_bytes"), json.at("jobs")};
  } catch (const core::EnvironmentError &) {
    return {};
  } catch (const Json::exception &) {
    return {};
  }
}
} // namespace ligament::program
