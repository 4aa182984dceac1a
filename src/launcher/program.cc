#include "src/launcher/program.h"

#include "core/check.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <new>

namespace ligament::program
{
namespace
{
using Json = nlohmann::ordered_json;

Json as_json(const std::vector<core::Diagnostic> &diagnostics)
{
  Json list = Json::array();
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

int fail(const CommandLine &line, const std::string &message, ExitCode code)
{
  fmt::print(stderr, "{}error: {}\n", line.scene.empty() ? "" : line.scene + ": ", message);
  if (line.json)
    fmt::print("{}\n", error_json(message));
  return int(code);
}
} // namespace

int run_program(int argc, char **argv,
                int (*dispatch)(const CommandLine &line, int argc, char **argv))
{
  const CommandLine line = parse_command_line(argc, argv);
  if (line.exit_code)
    return *line.exit_code;
  try {
    return dispatch(line, argc, argv);
  } catch (const core::InputError &error) {
    return fail(line, error.what(), ExitCode::wrong_input);
  } catch (const core::GuardStop &error) {
    return fail(line, error.what(), ExitCode::stopped_by_guard);
  } catch (const std::bad_alloc &) {
    return fail(line, "not enough memory; `ligament check` predicts what the scene needs",
                ExitCode::bad_environment);
  } catch (const std::exception &error) {
    return fail(line, error.what(), ExitCode::bad_environment);
  }
}

int refuse(const CommandLine &line, const std::string &file,
           const std::vector<core::Diagnostic> &errors,
           const std::vector<core::Diagnostic> &warnings)
{
  for (const core::Diagnostic &d : errors)
    fmt::print(stderr, "{}\n", to_string(d));
  const std::size_t n = errors.size();
  fmt::print(stderr, "{}: {} error{}, nothing was computed\n", file, n, n == 1 ? "" : "s");
  if (line.json)
    fmt::print("{}\n", Json{{"status", "wrong input"},
                            {"errors", as_json(errors)},
                            {"warnings", as_json(warnings)}}
                           .dump());
  return int(ExitCode::wrong_input);
}
} // namespace ligament::program
