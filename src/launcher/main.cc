// The program that users type: answers help, version, explain and wrong input at once, leaves the
// computing to the solver.
#include "core/check.h"
#include "core/input_file.h"
#include "core/tell.h"
#include "src/analysis/compare.h"
#include "src/analysis/report.h"
#include "src/analysis/verdict.h"
#include "src/launcher/new_command.h"
#include "src/launcher/program.h"
#include "src/launcher/ranks_start.h"
#include "src/launcher/solver_start.h"
#include "src/launcher/sweep_command.h"
#include "src/output/run_folder.h"
#include "src/output/run_record.h"
#include "src/scene/check_ranks.h"
#include "src/sweep/study.h"

#include <fmt/format.h>

#include <cstdio>

namespace
{
using namespace ligament;
using namespace ligament::program;

int compute(const CommandLine &line, int argc, char **argv)
{
  if (launched_ranks() > 1) // one of several: the solver says on the first one what is wrong
    start_solver(argc, argv);
  const ReadResult result = read_scene(line.scene, line.overrides);
  for (const core::Diagnostic &d : result.warnings)
    core::tell(stderr, to_string(d) + "\n");
  if (result.scene && line.ranks > 1) {
    core::require(core::is_named_file(line.scene) || line.command == "check",
                  "standard input and pipes reach the first rank alone; give a file");
    const auto refused = refused_on_ranks(result);
    if (!refused.empty())
      return refuse(line, line.scene, refused, result.warnings);
    if (line.command == "run")
      return run_on_ranks(line, argc, argv);
  }
  if (result.scene) {
    if (!core::is_named_file(line.scene))
      refill_standard_input(result.text);
    start_solver(argc, argv);
  }
  return refuse(line, line.scene, result.errors, result.warnings);
}

void print_explanation(const CommandLine &line)
{
  if (line.explain_study && line.json)
    fmt::print("{}\n", json_text(nlohmann::ordered_json::parse(study_schema())));
  else if (line.explain_study)
    fmt::print("{}", line.schema ? study_schema() : study_markdown());
  else if (line.schema)
    fmt::print("{}\n", json_text(json_schema(), line.json ? -1 : 2));
  else if (line.markdown && !line.json)
    fmt::print("{}", reference_markdown());
  else if (line.json)
    fmt::print("{}\n", json_text({{"status", "done"}, {"keys", explain_json(line.key)}}));
  else
    fmt::print("{}", explain(line.key));
}

ExitCode code_of(bool complete)
{
  return complete ? ExitCode::done : ExitCode::stopped_by_guard;
}

/// The table stands before anything is written; without a folder that was asked for, a plot less is
/// a warning.
ExitCode print_comparison(const CommandLine &line)
{
  CompareResult result = compare(line.run, line.reference);
  fmt::print("{}", table(result));
  std::fflush(stdout);
  try {
    write_comparison(result, line.output.empty() ? line.run : line.output);
  } catch (const core::EnvironmentError &error) {
    if (!line.output.empty())
      throw;
    core::tell(stderr, fmt::format("warning: no plot: {}; give a folder for it with --output\n",
                                   error.what()));
  }
  if (line.json) {
    nlohmann::ordered_json json = to_json(result);
    json["status"] = result.complete ? "done" : "stopped";
    fmt::print("{}\n", json_text(json));
  }
  return code_of(result.complete);
}

std::string report_of(const CommandLine &line)
{
  if (!line.output.empty())
    return write_report(line.run, line.fields, line.output);
  try {
    return write_report(line.run, line.fields);
  } catch (const core::EnvironmentError &error) {
    throw core::EnvironmentError(error.what() +
                                 std::string("; give a folder for it with --output"));
  }
}

ExitCode print_report(const CommandLine &line)
{
  const std::string file = report_of(line);
  const RunRecord record = read_run_record(RunFolder{line.run}.record());
  fmt::print("{}\n", file);
  if (!record.is_complete())
    fmt::print("the run {}\n", incompleteness_with_reason(record));
  if (line.json)
    fmt::print("{}\n", json_text({{"report", file},
                                  {"status", record.status},
                                  {"complete", record.is_complete()}}));
  return code_of(record.is_complete());
}

int dispatch(const CommandLine &line, int argc, char **argv)
{
  if (line.command == "new")
    return new_command(line);
  if (line.command == "sweep")
    return sweep_command(line);
  if (line.command == "run" || line.command == "check")
    return compute(line, argc, argv);
  if (line.command == "resume" && line.ranks > 1 && launched_ranks() == 1)
    return run_on_ranks(line, argc, argv);
  if (line.command == "resume")
    start_solver(argc, argv);
  if (line.command == "verify")
    start_verification(argc, argv);
  if (line.command == "explain")
    print_explanation(line);
  else if (line.command == "compare")
    return int(print_comparison(line));
  else
    return int(print_report(line));
  return int(ExitCode::done);
}

} // namespace

int main(int argc, char **argv)
{
  return run_program(argc, argv, dispatch);
}
