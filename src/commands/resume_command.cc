#include "core/check.h"
#include "core/files.h"
#include "core/tell.h"
#include "core/version.h"
#include "particles/instruction_set.h"
#include "src/commands/commands.h"
#include "src/commands/rank_process.h"
#include "src/commands/run_end.h"
#include "src/commands/simulate.h"
#include "src/launcher/program.h"
#include "src/scene/check_ranks.h"
#include "src/scene/scene_difference.h"
#include "src/simulation/gauges/gauge_set.h"
#include "src/simulation/reference.h"

#include <fmt/format.h>

#include <filesystem>

namespace ligament::program
{
namespace
{
Checkpoint newest_checkpoint(const RunFolder &folder)
{
  FoundCheckpoint found = Checkpoints(folder.checkpoints()).newest_good();
  for (const std::string &reason : found.passed_over)
    core::tell(stderr, fmt::format("warning: a checkpoint cannot be used: {}\n", reason));
  core::require(found.checkpoint.has_value(),
                folder.path + ": there is no checkpoint to go on from; repeat the run");
  if (const std::string &lost = found.checkpoint->reference_lost; !lost.empty())
    core::tell(stderr,
               fmt::format("warning: what the set-up had found is lost, and is sought again: "
                           "{}\n",
                           lost));
  for (const std::string &lost : found.checkpoint->kept_lost)
    core::tell(stderr, fmt::format("warning: a picture or a snapshot of the run so far is lost: "
                                   "{}\n",
                                   lost));
  return std::move(*found.checkpoint);
}

/// What one rank has lost the others do without: they keep and seek it together.
void share_losses(Checkpoint &checkpoint, const core::Ranks &ranks)
{
  if (ranks.any(!checkpoint.reference_lost.empty()))
    checkpoint.reference.clear();
  std::vector<std::int64_t> is_lost;
  for (const auto &[name, sum] : checkpoint.manifest.kept)
    is_lost.push_back(checkpoint.kept.count(name) == 0);
  is_lost = ranks.max(is_lost);
  std::size_t k = 0;
  for (const auto &[name, sum] : checkpoint.manifest.kept)
    if (is_lost[k++] && checkpoint.kept.erase(name) > 0)
      core::tell(stderr, fmt::format("warning: a picture or a snapshot of the run so far is lost: "
                                     "another rank cannot read the kept state {}\n",
                                     name));
}

/// That of the checkpoint with the duration and the output that the run was last told: a prolonged
/// one may have been killed before its next checkpoint.
nlohmann::ordered_json wanted_scene(const RunFolder &folder, const CheckpointManifest &manifest)
{
  nlohmann::ordered_json wanted = manifest.scene;
  try {
    const auto told = nlohmann::ordered_json::parse(core::read_file(folder.resolved_scene()));
    const nlohmann::ordered_json::json_pointer duration("/time/duration");
    wanted.at(duration) =
        std::max(wanted.at(duration).get<double>(), told.at(duration).get<double>());
    wanted.at("output") = told.at("output");
  } catch (const core::InputError &) { // the disk lost it
  } catch (const core::EnvironmentError &) {
  } catch (const nlohmann::ordered_json::exception &) {
  }
  return wanted;
}

/// The run's own scene unless another one is named. Particles that the run read from a file, or
/// packed itself, lie in its folder.
ReadResult scene_of(const CommandLine &line, const RunFolder &folder, const Checkpoint &checkpoint,
                    const nlohmann::ordered_json &was)
{
  std::vector<std::string> overrides = line.overrides;
  // That of a warm crystal takes a while to find, and is no key of the scene.
  const std::string lattice = "thermal_lattice", key = "/atoms/lattice_parameter";
  Reference reference(checkpoint.reference);
  const bool is_known = line.scene.empty() && !reference.names(lattice).empty() &&
                        was.value(nlohmann::ordered_json::json_pointer(key), 1.) == 0;
  if (is_known)
    overrides.push_back(fmt::format("{}={:.17g}", key, reference.value(lattice, {})));
  ReadResult input = line.scene.empty()
                         ? parse_scene(json_text(was, 2), folder.resolved_scene(), overrides)
                         : read_scene(line.scene, overrides);
  if (is_known && input.scene)
    input.resolved["atoms"]["lattice_parameter"] = 0.;
  if (input.scene && input.scene->zone.packing == PackingKind::file)
    input.scene->zone.packing_file = folder.packing();
  return input;
}

/// What a gauge left open follows from the duration that the run began with, also where it is
/// longer now.
void keep_smoothing(nlohmann::ordered_json &was, ReadResult &input)
{
  const double duration = was.at("time").at("duration");
  for (std::size_t k = 0; k < input.scene->gauges.size() && k < was["gauges"].size(); ++k) {
    GaugeParameters &gauge = input.scene->gauges[k];
    const double smoothing = was["gauges"][k].value("smoothing", 0.);
    if (gauge.kind != GaugeKind::crack_tip || gauge.smoothing > 0)
      continue;
    gauge.smoothing = smoothing > 0 ? smoothing : default_smoothing(duration);
    was["gauges"][k]["smoothing"] = input.resolved["gauges"][k]["smoothing"] = gauge.smoothing;
  }
}

void refuse_another_scene(const nlohmann::ordered_json &was, const nlohmann::ordered_json &is)
{
  std::string list;
  for (const KeyDifference &d : differences_that_matter(was, is))
    list += fmt::format("\n  {}: {}, was {}", d.key, d.is, d.was);
  core::require(list.empty(), "the scene is not the one of the run; only a longer /time/duration, "
                              "/output and where named files lie may differ, but so do" +
                                  list);
}

/// A run that came to its end goes on only where there is more to do.
void refuse_what_has_ended(const RunFolder &folder, const nlohmann::ordered_json &was,
                           const nlohmann::ordered_json &is)
{
  const nlohmann::ordered_json::json_pointer duration("/time/duration");
  if (is.at(duration) > was.at(duration))
    return;
  bool done = false;
  try {
    done = read_run_record(folder.record()).is_complete();
  } catch (const core::InputError &) {
    // A record that the disk lost says nothing; it is written again.
  }
  core::require(!done, folder.path + ": the run has come to its end; give a longer one with --set "
                                     "/time/duration=...");
}

std::vector<std::string> what_is_new(const CheckpointManifest &manifest)
{
  std::vector<std::string> warnings;
  const std::string same = "; its last digits may not be those of a run without a break";
  if (manifest.version != core::version() || manifest.commit != core::commit())
    warnings.push_back(fmt::format("the run began with version {}, commit {}, and goes on with "
                                   "version {}, commit {}{}",
                                   manifest.version, manifest.commit, core::version(),
                                   core::commit(), same));
  if (manifest.instructions != particles::instruction_set())
    warnings.push_back(fmt::format("the run began on a processor with {}, and goes on with {}{}",
                                   manifest.instructions, particles::instruction_set(), same));
  return warnings;
}

/// In bytes; 0 where there is no file.
std::int64_t size_of(const std::string &file)
{
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  return error ? 0 : std::int64_t(size);
}

/// A power failure may have taken the end of the log, which nobody waited for; other files have to
/// be as long as they were.
void refuse_what_is_lost(const RunFolder &folder, const CheckpointManifest &manifest)
{
  for (const auto &[name, bytes] : manifest.positions) {
    const std::string file = folder.path + "/" + name;
    const std::int64_t size = size_of(file);
    core::require(file == folder.log() || size >= bytes,
                  fmt::format("{} has {} bytes where {} were written", file, size, bytes));
  }
}

/// Takes off what the run wrote behind the checkpoint. Of the log that is what lies before `end`:
/// behind it the set-up has written.
void cut_back(const RunFolder &folder, const CheckpointManifest &manifest, std::int64_t end)
{
  Checkpoints(folder.checkpoints()).remove_newer_than(manifest.number);
  for (const auto &[name, bytes] : manifest.positions) {
    const std::string file = folder.path + "/" + name;
    if (file != folder.log())
      core::cut_file(file, bytes);
    else if (end > bytes) {
      const std::string set_up = core::read_file(file).substr(std::size_t(end));
      core::cut_file(file, bytes);
      core::OutputFile(file, core::OutputFile::Mode::append).write(set_up);
    }
  }
}
/// Tables that a run writes at its end: those of an earlier end would be taken for what broke up to
/// where the run is now.
void remove_tables_of_the_end(const RunFolder &folder)
{
  for (const std::string &file : {folder.broken_bonds(), folder.fragments()}) {
    std::error_code error;
    std::filesystem::remove(file, error);
    core::require<core::EnvironmentError>(
        !error, fmt::format("cannot remove {}, of the earlier end of the run: {}; remove it, then "
                            "resume again",
                            file, error.message()));
  }
}
} // namespace

int resume_command(const CommandLine &line, const core::Ranks &ranks)
{
  core::Interruption interruption;
  RunOptions options{end_request(line, interruption), nullptr, line.rebuild_interval, ranks,
                     line.in_pieces, line.json};
  const RunFolder folder{line.run};
  std::optional<OpenRun> run; // of the first rank, which locks it before anybody reads
  if (ranks.is_first())
    run.emplace(folder);
  ranks.any(false);
  Checkpoint checkpoint = newest_checkpoint(folder);
  // Ranks read it for themselves, maybe not from the same machine.
  ranks.agree_on("the newest checkpoint that can be read", double(checkpoint.manifest.number));
  share_losses(checkpoint, ranks);
  options.from = &checkpoint;
  const CheckpointManifest &manifest = checkpoint.manifest;
  const nlohmann::ordered_json wanted = wanted_scene(folder, manifest);
  ReadResult input = scene_of(line, folder, checkpoint, wanted);
  const std::string name = line.scene.empty() ? folder.resolved_scene() : line.scene;
  require_one_mind(bool(input.scene), ranks);
  if (!input.scene)
    return refuse(line, name, input.errors, input.warnings);
  if (!ranks.is_one())
    if (const auto refused = refused_on_ranks(input); !refused.empty())
      return refuse(line, name, refused, input.warnings);
  nlohmann::ordered_json was = manifest.scene;
  keep_smoothing(was, input);
  refuse_another_scene(was, input.resolved);
  refuse_what_has_ended(folder, wanted, input.resolved);
  const std::vector<std::string> warnings = what_is_new(manifest);
  ranks.any(false); // all have read what the first one now changes
  if (!ranks.is_first())
    return follow(input, folder, interruption, options);

  refuse_what_is_lost(folder, manifest);
  const std::int64_t end_of_log = size_of(folder.log());
  // A run whose set-up fails stays as it is.
  options.make_way = [&] {
    RunRecord first = first_record(*input.scene, ranks);
    first.started = manifest.started;
    run->go_on(first);
    write_resolved(input, folder);
    cut_back(folder, manifest, end_of_log);
    remove_tables_of_the_end(folder);
  };
  const RunRecord record = simulate(input, warnings, *run, interruption, options);
  return end_of_run(line, line.run, folder, record, interruption);
}
} // namespace ligament::program
