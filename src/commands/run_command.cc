#include "src/commands/commands.h"

#include "core/files.h"
#include "core/input_file.h"
#include "core/interruption.h"
#include "core/tell.h"
#include "core/version.h"
#include "src/analysis/report.h"
#include "src/analysis/verdict.h"
#include "src/commands/peak_memory.h"
#include "src/launcher/program.h"
#include "src/output/open_run.h"
#include "src/simulation/simulation.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <filesystem>

namespace ligament::program
{
std::string output_folder(const CommandLine &line)
{
  if (!line.output.empty()) {
    const auto path = std::filesystem::path(line.output).lexically_normal();
    return path.has_filename() ? path.string() : path.parent_path().string();
  }
  if (!core::is_named_file(line.scene))
    return "ligament-out";
  // scene.json in a folder of its own is named after the folder.
  const std::filesystem::path scene = std::filesystem::absolute(line.scene);
  const std::string name =
      scene.stem() == "scene" ? scene.parent_path().filename().string() : scene.stem().string();
  return name + "-out";
}

namespace
{
/// What the record says before the body is built.
RunRecord first_record(const Scene &scene)
{
  RunRecord record;
  record.title = scene.title;
  record.version = core::version();
  record.commit = core::commit();
  record.started = fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", fmt::gmtime(std::time(nullptr)));
  record.dimension = scene.dimension;
  record.reason = "it is being set up, or was killed then";
  return record;
}

template <int dim>
RunRecord simulate(const ReadResult &input, const RunFolder &folder,
                   core::Interruption &interruption)
{
  Simulation<dim> simulation(*input.scene, folder, stderr);
  for (const core::Diagnostic &d : input.warnings)
    simulation.warn(fmt::format("{}: {}", to_string(d.place), d.message));
  interruption.leave_to_caller();
  return simulation.run(&interruption);
}

/// The run, with what stopped it in its record.
RunRecord simulate(const ReadResult &input, OpenRun &run, core::Interruption &interruption)
{
  interruption.end_at_once([&run](int signal) {
    run.end("interrupted", std::string(core::Interruption::name(signal)) + " asked for the end");
  });
  try {
    core::write_file(run.folder().resolved_scene(), json_text(input.resolved, 2) + "\n");
    return input.scene->dimension == 2 ? simulate<2>(input, run.folder(), interruption)
                                       : simulate<3>(input, run.folder(), interruption);
  } catch (const core::GuardStop &error) {
    run.end("stopped", error.what());
    throw;
  } catch (const std::exception &error) {
    run.end("failed", error.what());
    throw;
  }
}

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
    return core::Interruption::exit_code(interruption.signal());
  return int(record.status == "failed" ? ExitCode::bad_environment : ExitCode::stopped_by_guard);
}
} // namespace

int run_command(const CommandLine &line, const ReadResult &input)
{
  core::Interruption interruption;
  OpenRun run(RunFolder{output_folder(line)}, first_record(*input.scene), stderr);
  const RunRecord record = simulate(input, run, interruption);
  const std::string report = report_of(run.folder());
  if (record.status == "failed")
    core::tell(stderr, fmt::format("{}: error: {}\n", line.scene, record.reason));
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
                                   {"output", run.folder().path}};
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
