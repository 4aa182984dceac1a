#include "src/launcher/command_line.h"

#include "core/input_file.h"
#include "core/parameters/spelling.h"
#include "core/tell.h"
#include "core/version.h"
#include "src/launcher/scene_kinds.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string_view>

namespace ligament::program
{
namespace
{
/// CLI11's own check names the largest number there is as the upper bound, with all digits.
CLI::Validator above_zero()
{
  return {[](const std::string &text) {
            double value = 0;
            if (!CLI::detail::lexical_cast(text, value))
              return fmt::format("\"{}\" is no number; give one without a unit", text);
            return value > 0 ? std::string() : fmt::format("{} is not above 0", text);
          },
          ""};
}

void add_override_option(CLI::App &app, CommandLine &line)
{
  // One value per --set: what follows belongs to other options.
  app.add_option("--set", line.overrides, "replaces a value of the scene; may be repeated")
      ->type_name("/PATH=VALUE")
      ->type_size(1)
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false);
}

void add_wall_time_option(CLI::App &app, CommandLine &line)
{
  app.add_option("--wall-time", line.wall_time,
                 "ends in time with a checkpoint, s of wall time; `ligament resume` goes on")
      ->type_name("SECONDS")
      ->check(above_zero());
}

/// For tests of the program itself: help and manual leave it out.
void add_rebuild_option(CLI::App &app, CommandLine &line)
{
  app.add_option("--rebuild-interval", line.rebuild_interval)->check(above_zero())->group("");
}

void add_scene_options(CLI::App &app, CommandLine &line)
{
  app.add_option("scene", line.scene, "scene file")->required()->type_name("SCENE");
  add_override_option(app, line);
  app.add_option("--output,-o", line.output, "folder for the results")->type_name("DIR");
}

void add_ranks_option(CLI::App &app, CommandLine &line, const char *text)
{
  app.add_option("-n", line.ranks, text)->type_name("RANKS")->check(CLI::Range(1, 1 << 16));
}

void add_pieces_option(CLI::App &app, CommandLine &line)
{
  app.add_flag("--pieces", line.in_pieces,
               "with -n: every process writes the fields of its own particles (.pvtp)");
}

void declare(CLI::App &app, CommandLine &line)
{
  app.require_subcommand(1);
  app.set_version_flag("--version",
                       fmt::format("ligament {} (commit {})", core::version(), core::commit()));
  app.failure_message(CLI::FailureMessage::help);

  CLI::App &run = *app.add_subcommand("run", "computes a scene");
  add_scene_options(run, line);
  add_ranks_option(run, line,
                   "processes that compute it together, with the results of one to the bit");
  add_pieces_option(run, line);
  add_wall_time_option(run, line);
  add_rebuild_option(run, line);

  CLI::App &resume = *app.add_subcommand("resume", "goes on with a run from its newest checkpoint");
  resume.add_option("run", line.run, "folder of the run")->required()->type_name("RUN");
  resume
      .add_option("--scene", line.scene,
                  "scene file in place of the run's own; only a longer duration and what is "
                  "written may differ")
      ->type_name("SCENE");
  add_override_option(resume, line);
  add_ranks_option(resume, line, "processes that go on with it, as many as you like");
  add_pieces_option(resume, line);
  add_wall_time_option(resume, line);
  add_rebuild_option(resume, line);

  CLI::App &check =
      *app.add_subcommand("check", "everything but time stepping: errors, sizes, steps, cost");
  add_scene_options(check, line);
  add_ranks_option(check, line, "says whether so many processes may compute it together");
  check.add_flag("--draw", line.draw, "also draws zones and boundary conditions");
  check.add_flag("--full", line.full,
                 "builds the bodies whatever their size, instead of answering from volumes");

  CLI::App &begin = *app.add_subcommand("new", "writes a commented scene to begin with");
  begin.add_option("kind", line.kind, "of test; without it: a list of all kinds")
      ->type_name("KIND");
  begin
      .add_option("--output,-o", line.output,
                  "the file, which must not exist; - for standard output; without it: KIND.json")
      ->type_name("FILE");
  begin.footer("Kinds:\n" + list_of_kinds());

  CLI::App &compare = *app.add_subcommand("compare", "a run beside its reference");
  compare.add_option("run", line.run, "folder of the run")->required()->type_name("RUN");
  compare.add_option("reference", line.reference, "folder of the reference, or a CSV curve")
      ->required()
      ->type_name("REFERENCE");
  compare
      .add_option("--output,-o", line.output,
                  "folder for plot and page; without it: the folder of the run")
      ->type_name("DIR");

  CLI::App &sweep = *app.add_subcommand("sweep", "computes a study: many variants of a scene");
  sweep.add_option("study", line.study, "study file")->required()->type_name("STUDY");
  sweep
      .add_option("--jobs,-j", line.jobs,
                  "runs at the same time; 1, the default, measures clean times")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  sweep.add_flag("--dry-run", line.dry_run,
                 "lists the cases and what is finished, computes nothing");
  sweep
      .add_option("--output,-o", line.output,
                  "folder for the results; finished runs in it are kept")
      ->type_name("DIR");

  CLI::App &explain = *app.add_subcommand("explain", "default, unit, bounds and meaning of a key");
  explain.add_option("key", line.key, "such as /coupling/overlap_cells; without it: all keys")
      ->type_name("KEY");
  explain.add_flag("--markdown", line.markdown, "all keys, as the page of the manual")
      ->excludes("key");
  explain.add_flag("--schema", line.schema, "all keys, as JSON schema for editors")->excludes("key");
  explain.add_flag("--study", line.explain_study, "the keys of study files")->excludes("key");

  CLI::App &report = *app.add_subcommand("report", "writes the HTML report of a run again");
  report.add_option("run", line.run, "folder of the run")->required()->type_name("RUN");
  report
      .add_option("--field", line.fields,
                  "draws this field in place of the run's own pictures, such as stress_yy, "
                  "equivalent_stress, velocity; may be repeated")
      ->type_name("FIELD")
      ->type_size(1)
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false);
  report.add_option("--output,-o", line.output, "folder for it; without it: that of the run")
      ->type_name("DIR");

  CLI::App &verify = *app.add_subcommand("verify", "runs the built-in cases: is this build right?");
  verify
      .add_option("case", line.verify_case,
                  "one case, or all whose names begin so; without it: the default set")
      ->type_name("CASE");
  verify.add_flag("--full", line.full, "also the cases that take long");
  verify
      .add_flag("--stability", line.stability,
                "stability under stress; with --full 1e5 steps of each setting")
      ->excludes("case");
  verify
      .add_option("--seeds,--seed", line.seeds,
                  "random_scenes: one seed, whose files and runs are kept, or a range; what the "
                  "folder holds of a range is not computed again")
      ->type_name("N or FIRST:LAST")
      ->excludes("--stability");
  verify
      .add_option("--output,-o", line.output, "random_scenes with --seeds: folder for the results")
      ->type_name("DIR")
      ->needs("--seeds");

  for (CLI::App *command : app.get_subcommands({}))
    command->add_flag("--json", line.json, "ends with one JSON object on the last line");
}

/// All ways to write the options of a command.
std::vector<std::string> option_names(const CLI::App &command)
{
  std::vector<std::string> names = {"--help"};
  for (const CLI::Option *option : command.get_options())
    for (const std::string &name : option->get_lnames())
      names.push_back("--" + name);
  return names;
}

/// CLI11 says what it did not expect; this adds what was probably meant.
std::string explained(const CLI::ParseError &error, const CLI::App &app,
                      const std::vector<std::string> &words)
{
  std::vector<std::string> commands;
  for (const CLI::App *command : app.get_subcommands({}))
    commands.push_back(command->get_name());
  const auto verb = std::find_if(words.begin(), words.end(),
                                 [](const std::string &word) { return word.rfind('-', 0) != 0; });
  if (verb == words.end())
    return "a command is missing: " + core::listed(commands);
  const auto known = std::find(commands.begin(), commands.end(), *verb);
  if (known == commands.end()) {
    const std::string meant = core::did_you_mean(*verb, commands);
    return fmt::format("there is no command \"{}\"{}", *verb,
                       meant.empty() ? "; the commands are " + core::listed(commands, "and")
                                     : meant);
  }
  const std::vector<std::string> options = option_names(*app.get_subcommand(*verb));
  for (const std::string &word : words)
    if (word.rfind("--", 0) == 0) {
      const std::string name = word.substr(0, word.find('='));
      if (std::find(options.begin(), options.end(), name) == options.end())
        return fmt::format("\"{}\" has no option {}{}", *verb, name,
                           core::did_you_mean(name, options));
    }
  return error.what();
}
} // namespace

std::string json_text(const nlohmann::ordered_json &json, int indent)
{
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string error_json(const std::string &status, const std::string &message)
{
  return json_text(
      {{"status", status}, {"errors", nlohmann::ordered_json::array({{{"message", message}}})}});
}

CommandLine parse_command_line(int argc, const char *const *argv)
{
  CommandLine line;
  CLI::App app("Ligament: fracture of large specimens, discrete elements where they break, finite "
               "elements around",
               "ligament");
  declare(app, line);
  try {
    app.parse(argc, argv);
    line.command = app.get_subcommands().front()->get_name();
  } catch (const CLI::ParseError &error) {
    // Exit code 2 for all mistakes; CLI11 counts help and version as errors with code 0.
    line.exit_code = error.get_exit_code() == 0 ? app.exit(error) : 2;
    if (*line.exit_code == 0)
      return line;
    const std::string message = explained(error, app, {argv + 1, argv + argc});
    core::tell(stderr, fmt::format("error: {}\n  remedy: see ligament --help\n", message));
    const bool json = std::any_of(
        argv, argv + argc, [](const char *word) { return std::string_view(word) == "--json"; });
    if (json)
      fmt::print("{}\n", error_json("wrong input", message));
  }
  return line;
}

std::string output_folder(const CommandLine &line)
{
  if (!line.output.empty()) {
    const auto path = std::filesystem::path(line.output).lexically_normal();
    return path.has_filename() ? path.string() : path.parent_path().string();
  }
  if (!core::is_named_file(line.scene))
    return "ligament-out";
  // scene.json in a folder of its own is named after the folder.
  const auto scene = std::filesystem::absolute(line.scene).lexically_normal();
  const std::string name =
      scene.stem() == "scene" ? scene.parent_path().filename().string() : scene.stem().string();
  return name + "-out";
}
} // namespace ligament::program
