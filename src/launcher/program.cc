#include "src/launcher/program.h"

#include "core/check.h"
#include "core/tell.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <system_error>

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

int fail(const CommandLine &line, const OnFailure &on_failure, const std::string &message,
         const char *status, ExitCode code)
{
  core::tell(stderr,
             fmt::format("{}error: {}\n", line.scene.empty() ? "" : line.scene + ": ", message));
  if (line.json)
    fmt::print("{}\n", error_json(status, message));
  std::fflush(stdout);
  if (on_failure)
    on_failure(message, int(code));
  return int(code);
}

int run_command_line(const CommandLine &line, int argc, char **argv, const Dispatch &dispatch,
                     const OnFailure &on_failure)
{
  try {
    return dispatch(line, argc, argv);
  } catch (const core::InputError &error) {
    return fail(line, on_failure, error.what(), "wrong input", ExitCode::wrong_input);
  } catch (const core::GuardStop &error) {
    return fail(line, on_failure, error.what(), "stopped", ExitCode::stopped_by_guard);
  } catch (const std::bad_alloc &) {
    return fail(line, on_failure,
                "not enough memory; `ligament check` predicts what the scene needs", "failed",
                ExitCode::bad_environment);
  } catch (const std::exception &error) {
    return fail(line, on_failure, error.what(), "failed", ExitCode::bad_environment);
  }
}
} // namespace

int run_program(int argc, char **argv, const Dispatch &dispatch, const OnFailure &on_failure)
{
  // A limit on the size of files is to be an error of the write, not the end of the process.
  std::signal(SIGXFSZ, SIG_IGN);
  int code = int(ExitCode::bad_environment);
  std::string reason;
  try {
    const CommandLine line = parse_command_line(argc, argv);
    code =
        line.exit_code ? *line.exit_code : run_command_line(line, argc, argv, dispatch, on_failure);
  } catch (const std::system_error &error) { // of fmt::print, on a full device
    reason = error.what();
  }
  if (reason.empty() && std::fflush(stdout) == 0 && !std::ferror(stdout))
    return code;
  core::tell(stderr, fmt::format("error: cannot write to standard output: {}\n",
                                 reason.empty() ? std::strerror(errno) : reason));
  return code == int(ExitCode::done) ? int(ExitCode::bad_environment) : code;
}

int refuse(const CommandLine &line, const std::string &file,
           const std::vector<core::Diagnostic> &errors,
           const std::vector<core::Diagnostic> &warnings)
{
  for (const core::Diagnostic &d : errors)
    core::tell(stderr, to_string(d) + "\n");
  const std::size_t n = errors.size();
  core::tell(stderr,
             fmt::format("{}: {} error{}, nothing was computed\n", file, n, n == 1 ? "" : "s"));
  if (line.json)
    fmt::print("{}\n", json_text({{"status", "wrong input"},
                                  {"errors", as_json(errors)},
                                  {"warnings", as_json(warnings)}}));
  return int(ExitCode::wrong_input);
}
} // namespace ligament::program
