#include "src/commands/commands.h"

#include "core/input_file.h"
#include "src/commands/run_end.h"
#include "src/commands/simulate.h"
#include "src/launcher/program.h"
#include "src/scene/check_ranks.h"

#include <fmt/format.h>

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
  const auto scene = std::filesystem::absolute(line.scene).lexically_normal();
  const std::string name =
      scene.stem() == "scene" ? scene.parent_path().filename().string() : scene.stem().string();
  return name + "-out";
}

int run_command(const CommandLine &line, const ReadResult &input, const core::Ranks &ranks)
{
  if (!ranks.is_one())
    if (const auto refused = refused_on_ranks(input); !refused.empty())
      return refuse(line, line.scene, refused, input.warnings);
  core::Interruption interruption;
  const RunOptions options{end_request(line, interruption), nullptr, line.rebuild_interval, ranks,
                           line.in_pieces};
  const RunFolder folder{output_folder(line)};
  if (!ranks.is_first())
    return follow(input, folder, interruption, options);
  OpenRun run(folder, first_record(*input.scene, ranks), stderr);
  std::vector<std::string> warnings;
  for (const core::Diagnostic &d : input.warnings)
    warnings.push_back(fmt::format("{}: {}", to_string(d.place), d.message));
  const RunRecord record = simulate(input, warnings, run, interruption, options);
  return end_of_run(line, line.scene, run.folder(), record, interruption);
}
} // namespace ligament::program
