#include "src/verification/cases/random_scenes_run.h"

#include "core/check.h"
#include "core/files.h"
#include "packings/packing_file.h"
#include "src/output/broken_bonds.h"
#include "src/scene/read_scene.h"
#include "src/simulation/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>

namespace ligament::program
{
namespace
{
using Json = nlohmann::ordered_json;

// Runs that are compared up to the first broken face go on for so much longer.
constexpr double past_onset = 1.03;

/// The reasons of all errors; the scene without any.
Scene read(const Json &json)
{
  const ReadResult input = parse_scene(json.dump(), "scene");
  std::string reasons;
  for (const auto &error : input.errors)
    reasons += (reasons.empty() ? "" : "; ") + error.message;
  core::require(input.scene.has_value(), reasons);
  return *input.scene;
}

template <int dim>
RunRecord simulate(const Scene &scene, const RunFolder &folder)
{
  return Simulation<dim>(scene, folder, nullptr, false).run();
}

SceneRun run(const Json &json, const std::string &path)
{
  const Scene scene = read(json);
  const RunFolder folder{path};
  folder.create();
  SceneRun run;
  run.record = scene.dimension == 2 ? simulate<2>(scene, folder) : simulate<3>(scene, folder);
  run.history = read_csv(folder.history());
  run.broken = read_broken_bonds(folder.broken_bonds());
  std::stable_sort(run.broken.begin(), run.broken.end(),
                   [](const auto &a, const auto &b) { return a.time < b.time; });
  // Those without an energy are about input and files.
  const auto &warnings = run.record.warnings;
  run.n_warnings = std::count_if(warnings.begin(), warnings.end(),
                                 [](const RunWarning &w) { return w.energy.has_value(); });
  return run;
}

/// The mirror's particles: the image of those of a run.
template <int dim>
void mirror_packing(const std::string &from, const std::string &to)
{
  auto seeds = packings::read_packing_file<dim>(from);
  for (auto &x : seeds.centre)
    x[0] = -x[0];
  packings::write_packing_file(to, seeds);
}

Json mirror_of(const RandomScene &scene, const SceneRun &coupled, const std::string &folder)
{
  Json image = mirrored(scene.json);
  // The stable one follows from an iteration that depends on the numbers of the particles.
  image["time"].erase("step_fraction");
  image["time"]["step"] = coupled.record.dt;
  if (scene.packing != "random")
    return image;
  const std::string from = RunFolder{folder + "/coupled"}.packing(), to = folder + "/mirror.csv";
  scene.dimension == 2 ? mirror_packing<2>(from, to) : mirror_packing<3>(from, to);
  auto &zone = image["discrete_zone"];
  zone["packing"] = "file";
  zone["packing_file"] = std::filesystem::absolute(to).string();
  for (const char *key : {"seed", "size_ratio"})
    zone.erase(key);
  return image;
}

Json with_half_step(Json scene)
{
  auto &fraction = scene["time"]["step_fraction"];
  fraction = fraction.get<double>() / 2;
  return scene;
}

/// Without crack and hole, and so strong that nothing breaks.
Json whole_body(Json scene)
{
  for (const char *cuts : {"cracks", "holes"})
    scene["specimen"].erase(cuts);
  scene["material"]["fracture"] = {{"criterion", "none"}};
  scene["time"]["stop_when"] = "end";
  return scene;
}

Json mesh_alone(Json scene)
{
  scene["discrete_zone"]["extent"] = "none";
  return scene;
}

/// Peak loads of the runs with shorter steps.
std::vector<double> scattered_peaks(const Json &scene, const SceneRun &first,
                                    const std::string &folder)
{
  std::vector<double> peaks{first.record.peak_load.value_or(NAN)};
  for (const double share : {0.95, 0.9, 0.8, 0.5}) {
    Json shorter = scene;
    auto &fraction = shorter["time"]["step_fraction"];
    fraction = fraction.get<double>() * share;
    std::filesystem::remove_all(folder);
    const SceneRun other = run(shorter, folder);
    if (other.record.peak_load && other.record.status == "done")
      peaks.push_back(*other.record.peak_load);
  }
  return peaks;
}

Json up_to_onset(Json scene, const SceneRun &coupled)
{
  auto &duration = scene["time"]["duration"];
  if (const auto onset = coupled.onset())
    duration = std::min(duration.get<double>(), past_onset * *onset);
  return scene;
}
} // namespace

std::optional<double> SceneRun::onset() const
{
  return broken.empty() ? std::nullopt : std::optional(broken.front().time);
}

SceneRuns run_scene(const RandomScene &scene, const std::string &folder)
{
  const std::clock_t start = std::clock();
  SceneRuns runs;
  try {
    runs.coupled = run(scene.json, folder + "/coupled");
    runs.discrete = run(all_discrete(scene.json), folder + "/all_discrete");
  } catch (const core::InputError &error) {
    runs.refused = error.what();
    return runs;
  }
  runs.overlap = scene.json["coupling"]["overlap_cells"].get<double>() *
                 scene.json["far_field"]["cell_size"].get<double>();
  runs.far_step = runs.coupled.record.dt * runs.coupled.record.step_ratio;
  runs.half_step =
      run(up_to_onset(with_half_step(scene.json), runs.coupled), folder + "/half_step");
  // The factor of a toughness cannot be found for the packing of a file.
  runs.has_mirror = !(scene.toughness && scene.packing == "random");
  if (runs.has_mirror)
    try {
      runs.mirror = run(up_to_onset(mirror_of(scene, runs.coupled, folder), runs.coupled),
                        folder + "/mirror");
    } catch (const core::InputError &) {
      runs.is_mirrored = false;
    }
  runs.seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
  return runs;
}

void look_closer(const RandomScene &scene, const std::string &folder, bool at_stiffness,
                 bool at_peak, SceneRuns &runs)
{
  auto &closer = runs.closer;
  if (at_stiffness) {
    const Json whole = whole_body(scene.json);
    closer.mesh = run(mesh_alone(whole), folder + "/mesh");
    closer.particles = run(all_discrete(whole), folder + "/particles");
  }
  if (at_peak) {
    const std::string other = folder + "/other_step";
    closer.coupled_peaks = scattered_peaks(scene.json, runs.coupled, other);
    closer.discrete_peaks = scattered_peaks(all_discrete(scene.json), runs.discrete, other);
  }
}

void write_scene(const RandomScene &scene, const std::string &folder)
{
  std::filesystem::create_directories(folder);
  const auto write = [&](const char *name, const Json &json) {
    core::write_file(fmt::format("{}/{}.json", folder, name), json.dump(2) + "\n");
  };
  write("scene", scene.json);
  write("all_discrete", all_discrete(scene.json));
  write("half_step", with_half_step(scene.json));
  if (scene.packing != "random")
    write("mirror", mirrored(scene.json));
}
} // namespace ligament::program
