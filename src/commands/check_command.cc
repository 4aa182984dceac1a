#include "src/commands/commands.h"

#include "core/tell.h"
#include "packings/packing_file.h"
#include "src/commands/check_volumes.h"
#include "src/commands/cost_advice.h"
#include "src/commands/peak_memory.h"
#include "src/commands/ranks_cost.h"
#include "src/commands/scene_picture.h"
#include "src/commands/static_cost.h"
#include "src/launcher/program.h"
#include "src/output/run_folder.h"
#include "src/simulation/doubts.h"
#include "src/simulation/make_packing.h"
#include "src/simulation/recorder.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <filesystem>

namespace ligament::program
{
namespace
{
std::string duration_text(double seconds)
{
  if (seconds < 120)
    return fmt::format("{:.0f} s", seconds);
  if (seconds < 7200)
    return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

nlohmann::ordered_json gauges_json(const std::vector<GaugeEntry> &gauges)
{
  auto list = nlohmann::ordered_json::array();
  for (const GaugeEntry &g : gauges)
    list.push_back({{"name", g.name}, {"kind", g.kind}, {"columns", g.columns}, {"text", g.text}});
  return list;
}

template <int dim>
int check(const CommandLine &line, const ReadResult &input)
{
  const Scene &scene = *input.scene;
  core::Log log;
  core::Timers timers;
  auto body = make_body<dim>(scene, log, timers);
  doubt_body(scene, body, log);
  const double setup_seconds = timers.total();
  for (const std::string &text : log.warnings())
    core::tell(stderr, fmt::format("warning: {}\n", text));
  if (line.draw) {
    const std::string folder = output_folder(line);
    std::filesystem::create_directories(folder);
    const std::string file = folder + "/check.png";
    write_picture(file, scene_picture(body, scene));
    fmt::print("picture: {}\n", file);
    if (body.seeds) {
      const std::string packing = folder + "/check_packing.csv"; // that of a run stays
      packings::write_packing_file(packing, *body.seeds);
      fmt::print("packing: {}\n", packing);
    }
  }
  const GaugeSet<dim> gauges(scene, body);
  all_columns(scene, gauges, servo_targets(scene, body, gauges)); // a run would refuse them
  const StepCost cost = measure_step_cost(scene, body, timers, 0.5);
  // Predictions are of steps alone; a run with phases skips most of them, and how many nobody
  // knows.
  std::optional<StaticCost> equilibrium;
  const double body_memory = peak_memory();
  if (scene.time.has_phases())
    equilibrium = static_cost(scene, body);
  const double memory = body_memory + (equilibrium ? equilibrium->memory : 0);
  const long steps = std::lround(std::ceil(scene.time.duration / body.dt));
  const double output = output_seconds(scene, body, steps);
  const double seconds = setup_seconds + steps * cost.seconds_per_step + output;
  const int particles = body.zone ? body.zone->state.size() : 0;
  const int cells = body.far ? body.far->mesh().n_cells() : 0;
  const auto *joined = body.coupler->overlap();
  const int overlap = joined ? int(joined->members.size()) : 0;
  const double critical = body.zone ? body.dt_zone : body.dt_far;

  fmt::print("{}\n", scene.title);
  fmt::print("  particles            {:>12}\n", particles);
  fmt::print("  cells                {:>12}\n", cells);
  fmt::print("  overlap particles    {:>12}\n", overlap);
  fmt::print("  pure discrete model  {:>12} particles\n", body.equivalent_particles);
  fmt::print("  step                 {:>12.4g} s ({:.2f} of the stable one)\n", body.dt,
             body.dt / critical);
  if (joined)
    fmt::print("  far field            {:>12} steps of the zone per step; {:.4g} s is stable\n",
               body.coupler->step_ratio(), body.dt_far);
  if (equilibrium)
    fmt::print("{}", to_text(*equilibrium, scene, cost.seconds_per_step));
  fmt::print("  steps                {:>12}{}\n", steps,
             equilibrium ? " without phases, which skip most of them" : "");
  fmt::print("  memory               {:>12.0f} MiB\n", memory / 1048576);
  fmt::print("  {:<20} {:>12}{}{}\n", equilibrium ? "time without phases" : "predicted time",
             duration_text(seconds), equilibrium ? " of a purely dynamic run" : "",
             scene.time.stop_when == StopWhen::end ? "" : ", less if it breaks earlier");
  std::optional<RanksCost> on_ranks;
  if (line.ranks > 1) {
    on_ranks = ranks_cost(scene, body, line.ranks, cost, body_memory,
                          equilibrium ? equilibrium->memory : 0);
    fmt::print("{}", to_text(*on_ranks, cost.seconds_per_step));
  }
  double saving = 0;
  std::optional<CostAdvice> advice;
  if (joined) {
    saving = cost.saving(body.equivalent_particles, particles);
    fmt::print("  predicted saving     {:>11.1f}x against pure discrete elements{}\n", saving,
               equilibrium ? ", in each time step" : "");
    if (saving < 1 && !equilibrium) { // the advice counts steps
      advice = advise(input, body, cost);
      fmt::print("{}", to_text(*advice, particles));
    }
  }
  if (const auto patch = body.figures.find("patch_residual"); patch != body.figures.end())
    fmt::print("  patch residual       {:>12.1e} of C11 h^(dim-1)\n", patch->second.value);
  for (const GaugeEntry &gauge : gauges.entries())
    fmt::print("  gauge {} ({}): {}\n", gauge.name, gauge.kind, gauge.text);
  for (const auto &part : body.skipped)
    fmt::print("  not needed: {} ({})\n", part.what, part.why);
  if (line.json) {
    nlohmann::ordered_json json = {{"status", "done"},
                                   {"particles", particles},
                                   {"cells", cells},
                                   {"overlap_particles", overlap},
                                   {"equivalent_particles", body.equivalent_particles},
                                   {"dt", body.dt},
                                   {"dt_critical", critical},
                                   {"steps", steps},
                                   {"memory_bytes", memory},
                                   {"available_memory_bytes", available_memory()},
                                   {"predicted_seconds", seconds},
                                   {"seconds_per_step", cost.seconds_per_step},
                                   {"output_seconds", output},
                                   {"setup_seconds", setup_seconds},
                                   {"predicted_saving", saving},
                                   {"advice", nullptr},
                                   {"built", true},
                                   {"not_checked", nlohmann::json::array()},
                                   {"errors", nlohmann::json::array()}};
    if (equilibrium) {
      json["predicted_seconds"] = json["output_seconds"] = nullptr;
      json["dynamic_seconds"] = seconds;
      json["loading"] = word_of(scene.time.loading);
      json["phases"] = nullptr;
      json["equilibrium"] = to_json(*equilibrium);
    }
    if (!gauges.entries().empty())
      json["gauges"] = gauges_json(gauges.entries());
    if (advice)
      json["advice"] = to_json(*advice);
    if (on_ranks)
      json["on_ranks"] = {{"ranks", on_ranks->ranks},
                          {"particles", on_ranks->largest_part},
                          {"ghosts", on_ranks->ghosts},
                          {"seconds_per_step", on_ranks->seconds_per_step},
                          {"mesh_seconds", on_ranks->mesh_seconds},
                          {"memory_bytes", on_ranks->memory},
                          {"other_memory_bytes", on_ranks->other_memory},
                          {"whole_body_at_first", on_ranks->whole_at_first}};
    fmt::print("{}\n", json_text(json));
  }
  return int(ExitCode::done);
}
} // namespace

int check_command(const CommandLine &line, const ReadResult &input)
{
  const bool particles = input.scene->zone.extent != DiscreteZone::Extent::none;
  const SizeEstimate size =
      estimate_size(*input.scene, particles ? mean_cell_volume(*input.scene) : 1);
  if (!line.full && std::max(size.particles, size.cells) > largest_built) {
    print_volumes(line, input, size);
    return int(ExitCode::done);
  }
  return input.scene->dimension == 2 ? check<2>(line, input) : check<3>(line, input);
}
} // namespace ligament::program
