// The program that computes: started by `ligament` with the same arguments.
#include "core/check.h"
#include "core/flush_denormals.h"
#include "src/commands/commands.h"
#include "src/launcher/program.h"
#include "src/launcher/solver_start.h"

namespace
{
using namespace ligament;
using namespace ligament::program;

int dispatch(const CommandLine &line, int, char **)
{
  require_one_rank(line.ranks);
  if (line.command == "verify")
    return verify_command(line);
  const ReadResult input = read_scene(line.scene, line.overrides);
  core::require(input.scene.has_value(), line.scene + ": the scene has errors; `ligament check` "
                                                      "lists them");
  return line.command == "run" ? run_command(line, input) : check_command(line, input);
}
} // namespace

// Before any thread is started.
int main(int argc, char **argv)
{
  core::flush_denormals();
  return run_program(argc, argv, dispatch);
}
