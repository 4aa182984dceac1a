#include "src/scene/scene_difference.h"

#include <algorithm>
#include <array>

namespace ligament::program
{
namespace
{
using Json = nlohmann::ordered_json;

const std::string duration = "/time/duration", output = "/output/";

/// Paths, which change where a project moves: what the files hold is compared by whoever opens
/// them.
const std::array<std::string, 3> files = {"/specimen/file", "/atoms/file",
                                          "/discrete_zone/packing_file"};

/// Lists of objects (loads, inclusions) are compared key by key, too; other lists as values.
bool is_section(const Json &value)
{
  return value.is_object() || (value.is_array() && !value.empty() && value.front().is_object());
}

std::string text_of(const Json *value)
{
  return value ? value->dump(-1, ' ', false, Json::error_handler_t::replace) : "nothing";
}

void compare(const std::string &key, const Json *was, const Json *is,
             std::vector<KeyDifference> &found)
{
  if (was && is && *was == *is)
    return;
  if (!was || !is || !is_section(*was) || !is_section(*is) || was->type() != is->type()) {
    found.push_back({key, text_of(was), text_of(is)});
    return;
  }
  const auto entry = [](const Json &section, const std::string &name) -> const Json * {
    if (section.is_array())
      return std::stoul(name) < section.size() ? &section[std::stoul(name)] : nullptr;
    const auto place = section.find(name);
    return place == section.end() ? nullptr : &*place;
  };
  for (const auto &[name, value] : was->items())
    compare(key + "/" + name, &value, entry(*is, name), found);
  for (const auto &[name, value] : is->items())
    if (!entry(*was, name))
      compare(key + "/" + name, nullptr, &value, found);
}
} // namespace

std::vector<KeyDifference> differences(const Json &was, const Json &is)
{
  std::vector<KeyDifference> found;
  compare("", &was, &is, found);
  return found;
}

std::vector<KeyDifference> differences_that_matter(const Json &was, const Json &is)
{
  std::vector<KeyDifference> found = differences(was, is);
  const auto may_differ = [&](const KeyDifference &d) {
    const Json::json_pointer key(duration);
    return d.key.rfind(output, 0) == 0 ||
           std::find(files.begin(), files.end(), d.key) != files.end() ||
           (d.key == duration && is.at(key) > was.at(key));
  };
  found.erase(std::remove_if(found.begin(), found.end(), may_differ), found.end());
  return found;
}
} // namespace ligament::program
