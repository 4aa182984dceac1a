#include "src/launcher/sweep_command.h"

#include "core/input_file.h"
#include "core/tell.h"
#include "src/launcher/program.h"
#include "src/launcher/solver_start.h"
#include "src/sweep/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace ligament::program
{
namespace
{
/// study.json in a folder of its own is named after the folder.
std::string default_folder(const std::string &study)
{
  if (!core::is_named_file(study))
    return "ligament-sweep";
  const auto file = std::filesystem::absolute(study).lexically_normal();
  const std::string name =
      file.stem() == "study" ? file.parent_path().filename().string() : file.stem().string();
  return name + "-sweep";
}

int list_cases(const CommandLine &line, const CaseList &list, const std::string &folder)
{
  const auto finished = finished_runs(folder);
  auto json = nlohmann::ordered_json::array();
  for (const Case &c : list.cases) {
    const bool done = c.refused.empty() && finished.count(scene_text(c.scene));
    const std::string state = !c.refused.empty() ? "refused" : done ? "finished" : "open";
    fmt::print("{:<8}  {:<16}  {}{}\n", state, c.id, c.name,
               c.refused.empty() ? "" : " (" + c.refused + ")");
    json.push_back({{"name", c.name}, {"id", c.id}, {"state", state}, {"reason", c.refused}});
  }
  if (line.json)
    fmt::print("{}\n", json_text({{"status", "done"}, {"cases", json}, {"output", folder}}));
  return int(ExitCode::done);
}

int count(const std::vector<CaseResult> &results, CaseEnd::Status status)
{
  int n = 0;
  for (const CaseResult &r : results)
    n += r.end.status == status;
  return n;
}

/// A row that others are measured against was not computed: their errors are missing.
bool lacks_a_reference(const std::vector<CaseResult> &results)
{
  return std::any_of(results.begin(), results.end(), [](const CaseResult &r) {
    return (r.is_reference || r.is_total_reference) && !r.end.run;
  });
}

int compute(const CommandLine &line, const Study &study, const CaseList &list,
            const std::string &path)
{
  StudyFolder folder(path);
  const auto ends = Sweep(list, folder, solver_path(), line.jobs, stderr).run();
  std::vector<std::string> notes;
  const auto results = evaluate(study, list, ends, notes);
  write_table(folder.table(), list, results);
  write_summary(folder, study, list, results, notes);
  for (const std::string &note : notes)
    core::tell(stderr, note + "\n");
  const int failed = count(results, CaseEnd::Status::failed),
            stopped = count(results, CaseEnd::Status::stopped);
  const bool incomplete = stopped > 0 || lacks_a_reference(results);
  fmt::print("{} cases: {} done, {} stopped by a guard, {} refused, {} failed\n", results.size(),
             count(results, CaseEnd::Status::done), count(results, CaseEnd::Status::stopped),
             count(results, CaseEnd::Status::refused), failed);
  fmt::print("table: {}\nsummary: {}\n", folder.table(), folder.summary());
  if (line.json) {
    int reused = 0;
    for (const auto &[id, end] : ends)
      reused += end.reused;
    fmt::print("{}\n", json_text({{"status", failed > 0   ? "failed"
                                             : incomplete ? "stopped"
                                                          : "done"},
                                  {"complete", failed == 0 && !incomplete},
                                  {"cases", results.size()},
                                  {"done", count(results, CaseEnd::Status::done)},
                                  {"stopped", count(results, CaseEnd::Status::stopped)},
                                  {"refused", count(results, CaseEnd::Status::refused)},
                                  {"failed", failed},
                                  {"reused", reused},
                                  {"table", folder.table()},
                                  {"summary", folder.summary()},
                                  {"output", folder.path()}}));
  }
  return int(failed > 0   ? ExitCode::bad_environment
             : incomplete ? ExitCode::stopped_by_guard
                          : ExitCode::done);
}
} // namespace

int sweep_command(const CommandLine &line)
{
  const StudyResult read = read_study(line.study);
  if (!read.study)
    return refuse(line, line.study, read.errors);
  const CaseList list = make_cases(*read.study, read.json);
  if (!list.errors.empty())
    return refuse(line, line.study, list.errors);
  for (const core::Diagnostic &warning : list.warnings)
    core::tell(stderr, to_string(warning) + "\n");
  const std::string folder = line.output.empty() ? default_folder(line.study) : line.output;
  return line.dry_run ? list_cases(line, list, folder) : compute(line, *read.study, list, folder);
}
} // namespace ligament::program
