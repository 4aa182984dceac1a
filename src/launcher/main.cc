// The program that users type: answers help, version, explain and wrong input at once, leaves the
// computing to the solver.
#include "core/check.h"
#include "src/launcher/command_line.h"
#include "src/launcher/solver_start.h"
#include "src/output/compare.h"
#include "src/output/report.h"
#include "src/scene/read_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace
{
using namespace ligament;
using namespace ligament::program;

enum ExitCode
{
  done = 0,
  wrong_input = 2,
  stopped_by_guard = 3,
  bad_environment = 4
};

nlohmann::ordered_json as_json(const std::vector<core::Diagnostic> &diagnostics)
{
  auto list = nlohmann::ordered_json::array();
  for (const core::Diagnostic &d : diagnostics)
    list.push_back({{"place", to_string(d.place)},
                    {"line", d.place.line},
                    {"column", d.place.column},
                    {"key", d.key},
                    {"message", d.message},
                    {"reason", d.reason},
                    {"remedy", d.remedy}});
  return list;
}

int compute(const CommandLine &line, int argc, char **argv)
{
  require_one_rank(line.ranks);
  const ReadResult result = read_scene(line.scene, line.overrides);
  for (const core::Diagnostic &d : result.warnings)
    fmt::print(stderr, "{}\n", to_string(d));
  for (const core::Diagnostic &d : result.errors)
    fmt::print(stderr, "{}\n", to_string(d));
  if (result.scene)
    start_solver(argc, argv);
  const std::size_t n = result.errors.size();
  fmt::print(stderr, "{}: {} error{}, nothing was computed\n", line.scene, n, n == 1 ? "" : "s");
  if (line.json)
    fmt::print("{}\n", nlohmann::ordered_json{{"status", "wrong input"},
                                              {"errors", as_json(result.errors)},
                                              {"warnings", as_json(result.warnings)}}
                           .dump());
  return wrong_input;
}

void print_explanation(const CommandLine &line)
{
  if (line.schema)
    fmt::print("{}\n", json_schema().dump(line.json ? -1 : 2));
  else if (line.markdown && !line.json)
    fmt::print("{}", reference_markdown());
  else if (line.json)
    fmt::print("{}\n", nlohmann::ordered_json{{"keys", explain_json(line.key)}}.dump());
  else
    fmt::print("{}", explain(line.key));
}

void print_comparison(const CommandLine &line)
{
  const CompareResult result = compare(line.run, line.reference);
  fmt::print("{}", table(result));
  if (line.json)
    fmt::print("{}\n", to_json(result).dump());
}

void print_report(const CommandLine &line)
{
  const std::string file = write_report(line.run);
  fmt::print("{}\n", file);
  if (line.json)
    fmt::print("{}\n", nlohmann::json{{"report", file}}.dump());
}

int dispatch(const CommandLine &line, int argc, char **argv)
{
  if (line.command == "run" || line.command == "check")
    return compute(line, argc, argv);
  if (line.command == "verify") {
    require_one_rank(line.ranks);
    start_solver(argc, argv);
  }
  if (line.command == "explain")
    print_explanation(line);
  else if (line.command == "compare")
    print_comparison(line);
  else
    print_report(line);
  return done;
}

/// The message on standard error, and as JSON when that was asked for.
int fail(const CommandLine &line, const std::string &message, ExitCode code)
{
  fmt::print(stderr, "error: {}\n", message);
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
    return dispatch(line, argc, argv);
  } catch (const core::InputError &error) {
    return fail(line, error.what(), wrong_input);
  } catch (const core::GuardStop &error) {
    return fail(line, error.what(), stopped_by_guard);
  } catch (const std::exception &error) {
    return fail(line, error.what(), bad_environment);
  }
}
