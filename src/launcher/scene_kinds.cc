#include "src/launcher/scene_kinds.h"

#include <fmt/format.h>

namespace ligament::program
{
std::string summary(const SceneKind &kind)
{
  const std::string line = kind.text.substr(0, kind.text.find('\n'));
  return line.substr(line.find_first_not_of("/ "));
}

std::string list_of_kinds()
{
  std::string list;
  for (const SceneKind &kind : scene_kinds())
    list += fmt::format("  {:<21}{}\n", kind.name, summary(kind));
  return list;
}
} // namespace ligament::program
