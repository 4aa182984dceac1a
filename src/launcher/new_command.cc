#include "src/launcher/new_command.h"

#include "core/check.h"
#include "core/files.h"
#include "core/parameters/spelling.h"
#include "src/launcher/program.h"
#include "src/launcher/scene_kinds.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>

namespace ligament::program
{
namespace
{
int list_kinds(const CommandLine &line)
{
  fmt::print("ligament new KIND writes KIND.json, a commented scene. The kinds are\n\n{}",
             list_of_kinds());
  auto json = nlohmann::ordered_json::array();
  for (const SceneKind &kind : scene_kinds())
    json.push_back({{"kind", kind.name}, {"summary", summary(kind)}});
  if (line.json)
    fmt::print("{}\n", json_text({{"status", "done"}, {"kinds", json}}));
  return int(ExitCode::done);
}

SceneKind chosen(const std::string &name)
{
  const std::vector<SceneKind> kinds = scene_kinds();
  std::vector<std::string> names;
  for (const SceneKind &kind : kinds)
    names.push_back(kind.name);
  const auto found = std::find(names.begin(), names.end(), name);
  const std::string meant = core::did_you_mean(name, names);
  core::require(
      found != names.end(),
      fmt::format("there is no kind \"{}\"{}", name,
                  meant.empty() ? "; the kinds are " + core::listed(names, "and") : meant));
  return kinds[found - names.begin()];
}
} // namespace

int new_command(const CommandLine &line)
{
  core::require(!line.kind.empty() || line.output.empty(),
                "--output names the file of a scene, and no kind of scene is named; "
                "\"ligament new\" lists the kinds");
  if (line.kind.empty())
    return list_kinds(line);
  const SceneKind kind = chosen(line.kind);
  const std::string file = line.output.empty() ? kind.name + ".json" : line.output;
  if (file == "-") {
    fmt::print("{}", kind.text);
    if (line.json)
      fmt::print("{}\n", json_text({{"status", "done"}, {"kind", kind.name}, {"scene", "-"}}));
    return int(ExitCode::done);
  }
  // Also a link that leads nowhere is somebody's.
  core::require(
      !std::filesystem::exists(std::filesystem::symlink_status(file)),
      fmt::format("{} exists and is not written over; give another name with --output", file));
  core::write_file(file, kind.text);
  fmt::print("{}: {}\nWhat it costs: ligament check {}\nTo compute it:  ligament run {}\n", file,
             summary(kind), file, file);
  if (line.json)
    fmt::print("{}\n", json_text({{"status", "done"}, {"kind", kind.name}, {"scene", file}}));
  return int(ExitCode::done);
}
} // namespace ligament::program
