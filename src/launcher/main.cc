// The program that users type: answers help, version, explain and wrong input at once, leaves the
// computing to the solver.
#include "src/launcher/program.h"
#include "src/launcher/solver_start.h"
#include "src/launcher/sweep_command.h"
#include "src/output/compare.h"
#include "src/output/report.h"
#include "src/output/run_folder.h"
#include "src/output/run_record.h"
#include "src/scene/read_scene.h"
#include "src/sweep/study.h"

#include <fmt/format.h>

#include <cstdio>

namespace
{
using namespace ligament;
using namespace ligament::program;

int compute(const CommandLine &line, int argc, char **argv)
{
  require_one_rank(line.ranks);
  const ReadResult result = read_scene(line.scene, line.overrides);
  for (const core::Diagnostic &d : result.warnings)
    fmt::print(stderr, "{}\n", to_string(d));
  if (result.scene)
    start_solver(argc, argv);
  return refuse(line, line.scene, result.errors, result.warnings);
}

void print_explanation(const CommandLine &line)
{
  if (line.explain_study)
    fmt::print("{}", line.schema ? study_schema() : study_markdown());
  else if (line.schema)
    fmt::print("{}\n", json_schema().dump(line.json ? -1 : 2));
  else if (line.markdown && !line.json)
    fmt::print("{}", reference_markdown());
  else if (line.json)
    fmt::print("{}\n", nlohmann::ordered_json{{"keys", explain_json(line.key)}}.dump());
  else
    fmt::print("{}", explain(line.key));
}

ExitCode code_of(bool complete)
{
  return complete ? ExitCode::done : ExitCode::stopped_by_guard;
}

ExitCode print_comparison(const CommandLine &line)
{
  const CompareResult result = compare(line.run, line.reference);
  fmt::print("{}", table(result));
  if (line.json)
    fmt::print("{}\n", to_json(result).dump());
  return code_of(result.complete);
}

ExitCode print_report(const CommandLine &line)
{
  const std::string file = write_report(line.run, line.fields);
  const RunRecord record = read_run_record(RunFolder{line.run}.record());
  fmt::print("{}\n", file);
  if (!record.is_complete())
    fmt::print("the run {}: {}\n", incompleteness(record), record.reason);
  if (line.json)
    fmt::print("{}\n", nlohmann::json{{"report", file},
                                      {"status", record.status},
                                      {"complete", record.is_complete()}}
                           .dump());
  return code_of(record.is_complete());
}

int dispatch(const CommandLine &line, int argc, char **argv)
{
  if (line.command == "sweep")
    return sweep_command(line);
  if (line.command == "run" || line.command == "check")
    return compute(line, argc, argv);
  if (line.command == "verify") {
    require_one_rank(line.ranks);
    start_solver(argc, argv);
  }
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
