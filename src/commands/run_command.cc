#include "src/commands/commands.h"

#include "src/commands/run_end.h"
#include "src/commands/simulate.h"
#include "src/launcher/program.h"
#include "src/scene/check_ranks.h"

#include <fmt/format.h>

namespace ligament::program
{
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
