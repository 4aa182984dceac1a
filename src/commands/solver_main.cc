// The program that computes: started by `ligament` with the same arguments.
#include "core/check.h"
#include "src/commands/commands.h"
#include "src/launcher/solver_start.h"

#include <fmt/format.h>

#include <new>

namespace
{
using namespace ligament;
using namespace ligament::program;

int dispatch(const CommandLine &line)
{
  require_one_rank(line.ranks);
  if (line.command == "verify")
    return verify_command(line);
  const ReadResult input = read_scene(line.scene, line.overrides);
  core::require(input.scene.has_value(), line.scene + ": the scene has errors; `ligament check` "
                                                      "lists them");
  return line.command == "run" ? run_command(line, input) : check_command(line, input);
}

int fail(const CommandLine &line, const std::string &message, int code)
{
  fmt::print(stderr, "{}error: {}\n", line.scene.empty() ? "" : line.scene + ": ", message);
  if (line.json)
    fmt::print("{}\n", error_json(message));
  return code;
}
} // namespace

int main(int argc, char **argv)
{
  const CommandLine line = parse_command_line(argc, argv);
  if (line.exit_code)
    return *line.exit_code;
  try {
    return dispatch(line);
  } catch (const core::InputError &error) {
    return fail(line, error.what(), 2);
  } catch (const core::GuardStop &error) {
    return fail(line, error.what(), 3);
  } catch (const std::bad_alloc &) {
    return fail(line, "not enough memory; `ligament check` predicts what the scene needs", 4);
  } catch (const std::exception &error) {
    return fail(line, error.what(), 4);
  }
}
