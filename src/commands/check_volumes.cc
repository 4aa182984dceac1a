#include "src/commands/check_volumes.h"

#include "core/log.h"
#include "src/commands/static_cost.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>

namespace ligament::program
{
namespace
{
using Json = nlohmann::ordered_json;

/// Largest need of the set-up in bytes per piece, as `ligament check` shows it for bodies of 1e5 to
/// 4e5 particles, and for cubic lattices of 1e7 (docs/verification_speed.md); most of it goes again
/// before the first step.
double memory_of(const Scene &scene, const SizeEstimate &size)
{
  const bool plane = scene.dimension == 2, lattice = !scene.zone.is_irregular();
  const double particle = lattice ? (plane ? 550 : 1050) : (plane ? 2300 : 4300);
  const double overlap = plane ? 1000 : 26000, cell = plane ? 420 : 800, program = 1.7e8;
  const double equilibrium =
      scene.time.has_phases() ? (plane ? 3 : 6) * equilibrium_bytes(scene.dimension) : 0;
  return program + particle * size.particles + overlap * size.overlap_particles +
         cell * size.cells + equilibrium * (size.particles + size.cells);
}

std::vector<std::string> not_checked(const CommandLine &line)
{
  std::vector<std::string> list = {"stable steps and the ratio of the steps", "time and saving",
                                   "whether the packing closes and its file fits",
                                   "the patch fit of the overlap",
                                   "whether the overlap keeps off held and loaded sides"};
  if (line.ranks > 1)
    list.push_back(fmt::format("what each of {} ranks has", line.ranks));
  if (line.draw)
    list.push_back("the picture, which is not drawn");
  return list;
}

/// How much of it the machine has left.
std::string memory_text(double needed)
{
  const double available = available_memory();
  if (available == 0)
    return "";
  return fmt::format(" of {:.0f} that the machine has left{}", available / 1048576,
                     needed > available ? ": NOT ENOUGH" : "");
}

Json json_of(const CommandLine &line, const Scene &scene, const SizeEstimate &size)
{
  const auto whole = [](double number) { return std::llround(number); };
  Json json = {{"status", "done"},
               {"particles", whole(size.particles)},
               {"cells", whole(size.cells)},
               {"overlap_particles", whole(size.overlap_particles)},
               {"equivalent_particles", whole(size.equivalent_particles)}};
  for (const char *name : {"dt", "dt_critical", "steps"})
    json[name] = nullptr;
  json["memory_bytes"] = memory_of(scene, size);
  json["available_memory_bytes"] = available_memory();
  for (const char *name : {"predicted_seconds", "seconds_per_step", "output_seconds",
                           "setup_seconds", "predicted_saving", "advice"})
    json[name] = nullptr;
  json["built"] = false;
  json["not_checked"] = not_checked(line);
  json["errors"] = Json::array();
  return json;
}
} // namespace

double available_memory()
{
  std::ifstream file("/proc/meminfo");
  std::string name, unit;
  for (double value; file >> name >> value;) {
    std::getline(file, unit);
    if (name == "MemAvailable:")
      return 1024 * value;
  }
  return 0;
}

void print_volumes(const CommandLine &line, const ReadResult &input, const SizeEstimate &size)
{
  const Scene &scene = *input.scene;
  const double memory = memory_of(scene, size);
  fmt::print("{}\n", scene.title);
  fmt::print("  too large to be built for a check: about, from volumes\n");
  fmt::print("  particles            {:>12.3g}\n", size.particles);
  fmt::print("  cells                {:>12.3g}\n", size.cells);
  fmt::print("  overlap particles    {:>12.3g}\n", size.overlap_particles);
  fmt::print("  pure discrete model  {:>12.3g} particles\n", size.equivalent_particles);
  fmt::print("  memory               {:>12.0f} MiB{}\n", memory / 1048576, memory_text(memory));
  for (const std::string &what : not_checked(line))
    fmt::print("  not checked: {}\n", what);
  fmt::print("  `ligament check --full` builds it\n");
  if (line.json)
    fmt::print("{}\n", json_text(json_of(line, scene, size)));
}
} // namespace ligament::program
