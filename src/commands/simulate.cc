#include "src/commands/simulate.h"

#include "core/files.h"
#include "core/version.h"
#include "src/launcher/command_line.h"
#include "src/simulation/simulation.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cstdio>
#include <ctime>

namespace ligament::program
{
RunRecord first_record(const Scene &scene, const core::Ranks &ranks)
{
  RunRecord record;
  record.title = scene.title;
  record.version = core::version();
  record.commit = core::commit();
  record.started = fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", fmt::gmtime(std::time(nullptr)));
  record.dimension = scene.dimension;
  record.ranks = ranks.size();
  record.reason = "it is being set up, or was killed then";
  return record;
}

namespace
{
template <int dim>
RunRecord simulate_in(const ReadResult &input, const std::vector<std::string> &warnings,
                      const RunFolder &folder, core::Interruption &interruption,
                      const RunOptions &options)
{
  Simulation<dim> simulation(*input.scene, folder, stderr, true, options.from, make_zone_force<dim>,
                             options.ranks);
  if (options.from)
    options.ranks.any(false);
  if (options.make_way)
    options.make_way();
  for (const std::string &text : warnings)
    simulation.warn(text);
  simulation.keep_checkpoints(input.resolved);
  simulation.rebuild_every(options.rebuild_interval);
  if (options.in_pieces)
    simulation.write_pieces();
  interruption.leave_to_caller();
  return simulation.run(options.end_request);
}
} // namespace

void write_resolved(const ReadResult &input, const RunFolder &folder)
{
  core::write_file(folder.resolved_scene(), json_text(input.resolved, 2) + "\n");
}

RunRecord simulate(const ReadResult &input, const std::vector<std::string> &warnings, OpenRun &run,
                   core::Interruption &interruption, const RunOptions &options)
{
  interruption.end_at_once([&run, &interruption, json = options.json](int signal) {
    const std::string why = std::string(core::Interruption::name(signal)) + " asked for the end";
    run.end("interrupted", why);
    // A second signal finds the caller at its own last words, and does not wait for who reads them.
    if (json && interruption.signal() == 0) {
      fmt::print("{}\n", error_json("interrupted", why));
      std::fflush(stdout);
    }
  });
  try {
    if (!options.from)
      write_resolved(input, run.folder());
    const auto &in_space = input.scene->dimension == 2 ? simulate_in<2> : simulate_in<3>;
    return in_space(input, warnings, run.folder(), interruption, options);
  } catch (const core::GuardStop &error) {
    run.end("stopped", error.what());
    throw;
  } catch (const std::exception &error) {
    run.end("failed", error.what());
    throw;
  }
}

int follow(const ReadResult &input, const RunFolder &folder, core::Interruption &interruption,
           const RunOptions &options)
{
  const auto &in_space = input.scene->dimension == 2 ? simulate_in<2> : simulate_in<3>;
  in_space(input, {}, folder, interruption, options);
  return 0;
}
} // namespace ligament::program
