#include "src/commands/run_end.h"

#include "core/tell.h"
#include "src/analysis/phases.h"
#include "src/analysis/report.h"
#include "src/analysis/verdict.h"
#include "src/commands/peak_memory.h"
#include "src/launcher/program.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace ligament::program
{
namespace
{
/// The report can be written again at any time: a run without it is whole.
std::string report_of(const RunFolder &folder)
{
  try {
    return write_report(folder.path);
  } catch (const std::exception &error) {
    core::tell(stderr, fmt::format("warning: no report: {}\n", error.what()));
    return "none";
  }
}

int exit_code(const RunRecord &record, const core::Interruption &interruption)
{
  if (record.status == "done")
    return int(ExitCode::done);
  if (record.status == "interrupted")
    return interruption.signal() ? core::Interruption::exit_code(interruption.signal())
                                 : out_of_time;
  return int(record.status == "failed" ? ExitCode::bad_environment : ExitCode::stopped_by_guard);
}
} // namespace

EndRequest end_request(const CommandLine &line, core::Interruption &interruption)
{
  using Clock = std::chrono::steady_clock;
  EndRequest request{&interruption};
  if (line.wall_time > 0) {
    const auto in = [now = Clock::now()](double seconds) {
      return now +
             std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    };
    request.deadline = in(line.wall_time - std::min(0.1 * line.wall_time, 60.));
    request.limit = in(line.wall_time);
  }
  return request;
}

int end_of_run(const CommandLine &line, const std::string &name, const RunFolder &folder,
               const RunRecord &record, const core::Interruption &interruption)
{
  const std::string report = report_of(folder);
  if (record.status == "failed")
    core::tell(stderr, fmt::format("{}: error: {}\n", name, record.reason));
  fmt::print("{}\n{}\n{}\nreport: {}\n", record.reason, headline(record), record.verdict, report);
  if (line.json) {
    nlohmann::ordered_json json = {{"status", record.status},
                                   {"complete", record.is_complete()},
                                   {"reason", record.reason},
                                   {"steps", record.steps},
                                   {"wall_seconds", record.wall_seconds},
                                   {"setup_seconds", record.setup_seconds},
                                   {"peak_memory_bytes", peak_memory()},
                                   {"peak_load", nullptr},
                                   {"largest_load", nullptr},
                                   {"broken_bonds", record.broken_bonds},
                                   {"broken_in_overlap", record.broken_in_overlap},
                                   {"energy_residual", nullptr},
                                   {"warnings", nlohmann::ordered_json::array()},
                                   {"output", folder.path}};
    if (!record.phases.empty()) {
      const PhaseTotals t = totals(record);
      json["static_phases"] = t.n_static;
      json["steps_skipped"] = t.skipped;
      json["solves"] = t.solves;
    }
    if (record.peak_load)
      json["peak_load"] = *record.peak_load;
    if (record.largest_load)
      json["largest_load"] = *record.largest_load;
    for (const RunWarning &warning : record.warnings)
      json["warnings"].push_back(warning.text);
    if (record.energy_residual)
      json["energy_residual"] = *record.energy_residual;
    fmt::print("{}\n", json_text(json));
  }
  return exit_code(record, interruption);
}
} // namespace ligament::program
