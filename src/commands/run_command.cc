#include "src/commands/commands.h"

#include "src/commands/peak_memory.h"
#include "src/launcher/program.h"
#include "src/output/report.h"
#include "src/output/verdict.h"
#include "src/simulation/simulation.h"

#include <fmt/format.h>

#include <filesystem>

namespace ligament::program
{
std::string output_folder(const CommandLine &line)
{
  if (!line.output.empty())
    return line.output;
  // scene.json in a folder of its own is named after the folder.
  const std::filesystem::path scene = std::filesystem::absolute(line.scene);
  const std::string name =
      scene.stem() == "scene" ? scene.parent_path().filename().string() : scene.stem().string();
  return name + "-out";
}

namespace
{
/// Nothing is written over: an older run moves to <folder>.1, .2, ...
void keep_older_run(const RunFolder &folder)
{
  if (!folder.holds_a_run())
    return;
  int n = 1;
  while (std::filesystem::exists(fmt::format("{}.{}", folder.path, n)))
    ++n;
  const std::string kept = fmt::format("{}.{}", folder.path, n);
  std::filesystem::rename(folder.path, kept);
  fmt::print(stderr, "{} held a run: moved to {}\n", folder.path, kept);
}

template <int dim>
RunRecord simulate(const ReadResult &input, const RunFolder &folder)
{
  Simulation<dim> simulation(*input.scene, folder, stderr);
  for (const core::Diagnostic &d : input.warnings)
    simulation.warn(fmt::format("{}: {}", to_string(d.place), d.message));
  return simulation.run();
}
} // namespace

int run_command(const CommandLine &line, const ReadResult &input)
{
  RunFolder folder{output_folder(line)};
  keep_older_run(folder);
  folder.create();
  core::write_file(folder.resolved_scene(), input.resolved.dump(2) + "\n");
  const RunRecord record =
      input.scene->dimension == 2 ? simulate<2>(input, folder) : simulate<3>(input, folder);
  const std::string report = write_report(folder.path);
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
    if (record.peak_load)
      json["peak_load"] = *record.peak_load;
    if (record.largest_load)
      json["largest_load"] = *record.largest_load;
    for (const RunWarning &warning : record.warnings)
      json["warnings"].push_back(warning.text);
    if (record.energy_residual)
      json["energy_residual"] = *record.energy_residual;
    fmt::print("{}\n", json.dump());
  }
  return int(record.is_complete() ? ExitCode::done : ExitCode::stopped_by_guard);
}
} // namespace ligament::program
