#include "src/commands/commands.h"

#include "src/commands/run_end.h"
#include "src/commands/simulate.h"
#include "src/launcher/program.h"
#include "src/scene/check_ranks.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace ligament::program
{
namespace
{
/// Files that a scene names in the folder of its own run: an earlier run there is moved aside
/// before they are read.
std::vector<core::Diagnostic> files_that_would_move(const ReadResult &input,
                                                    const std::string &folder)
{
  namespace fs = std::filesystem;
  const Scene &scene = *input.scene;
  std::vector<std::pair<std::string, std::string>> files = {
      {"/specimen/file", scene.specimen.file},
      {"/discrete_zone/packing_file", scene.zone.packing_file}};
  if (scene.atoms)
    files.emplace_back("/atoms/file", scene.atoms->file);
  const fs::path output = fs::weakly_canonical(folder);
  std::vector<core::Diagnostic> found;
  for (const auto &[key, file] : files) {
    if (file.empty())
      continue;
    const fs::path path = fs::weakly_canonical(file);
    if (std::mismatch(output.begin(), output.end(), path.begin(), path.end()).first == output.end())
      found.push_back({core::place_of(input.json, key), key,
                       fmt::format("{} lies in {}, where this run goes to", file, folder),
                       "a run that is there is moved aside before the file is read",
                       "copy the file to another place, or give another folder with --output"});
  }
  return found;
}
} // namespace

int run_command(const CommandLine &line, const ReadResult &input, const core::Ranks &ranks)
{
  if (!ranks.is_one())
    if (const auto refused = refused_on_ranks(input); !refused.empty())
      return refuse(line, line.scene, refused, input.warnings);
  const std::string path = output_folder(line);
  if (const auto refused = files_that_would_move(input, path); !refused.empty())
    return refuse(line, line.scene, refused, input.warnings);
  core::Interruption interruption;
  const RunOptions options{end_request(line, interruption), nullptr, line.rebuild_interval, ranks,
                           line.in_pieces, line.json};
  const RunFolder folder{path};
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
