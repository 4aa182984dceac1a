// The program that computes: started by `ligament` with the same arguments, alone or as one of
// several ranks.
#include "core/flush_denormals.h"
#include "core/input_file.h"
#include "core/keyed_error.h"
#include "src/commands/commands.h"
#include "src/commands/rank_process.h"
#include "src/launcher/program.h"
#include "src/launcher/solver_start.h"

namespace
{
using namespace ligament;
using namespace ligament::program;

/// What the launcher has read through a pipe lies in standard input now.
ReadResult read_again(const CommandLine &line)
{
  return core::is_named_file(line.scene)
             ? read_scene(line.scene, line.overrides)
             : parse_scene(core::read_input("-"), scene_name(line.scene), line.overrides);
}

/// `process`: null for one that is alone.
int dispatch(const CommandLine &line, RankProcess *process)
{
  const core::Ranks ranks = process ? process->ranks() : core::Ranks();
  core::require(ranks.is_one() || line.scene.empty() || core::is_named_file(line.scene),
                "standard input and pipes reach the first rank alone; give a file");
  if (process)
    process->is_of({line.command == "resume" ? line.run : output_folder(line)});
  if (line.command == "resume")
    return resume_command(line, ranks);
  if (line.command != "run")
    require_one_rank(line.command);
  const ReadResult input = read_again(line);
  require_one_mind(bool(input.scene), ranks);
  if (!input.scene)
    return refuse(line, line.scene, input.errors, input.warnings);
  try {
    return line.command == "run" ? run_command(line, input, ranks) : check_command(line, input);
  } catch (const core::KeyedError &error) {
    const core::Diagnostic found = {core::place_of(input.json, error.key), error.key, error.message,
                                    error.reason, error.remedy};
    const int code = refuse(line, line.scene, {found}, input.warnings);
    if (!ranks.is_one())
      process->end_all(to_string(found), code);
    return code;
  }
}
} // namespace

// Before any thread is started.
int main(int argc, char **argv)
{
  core::flush_denormals();
  if (launched_ranks() > 1)
    return run_rank(argc, argv, [](const CommandLine &line, RankProcess &process) {
      return dispatch(line, &process);
    });
  return run_program(argc, argv,
                     [](const CommandLine &line, int, char **) { return dispatch(line, nullptr); });
}
