#include "src/sweep/cases.h"

#include "src/scene/read_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <set>

namespace ligament::program
{
namespace
{
using core::JsonMember;
using core::JsonValue;
using core::Override;

void append(std::vector<Override> &overrides, const std::vector<JsonMember> &members)
{
  for (const JsonMember &m : members)
    overrides.push_back({m.key, m.value, m.place});
}

/// "overlap_cells" of "/coupling/overlap_cells"; a number says nothing without what it counts:
/// "velocity/1" of "/loads/0/velocity/1".
std::string last_part(const std::string &pointer)
{
  std::size_t slash = pointer.rfind('/');
  while (
      slash != std::string::npos && slash > 0 &&
      (std::isdigit(static_cast<unsigned char>(pointer[slash + 1])) || pointer[slash + 1] == '-'))
    slash = pointer.rfind('/', slash - 1);
  return pointer.substr(slash + 1);
}

std::string value_text(const JsonValue &value)
{
  return value.is(JsonValue::Kind::string) ? value.text : to_text(value);
}

std::string grid_name(const StudyGrid &grid)
{
  if (!grid.name.empty())
    return grid.name;
  std::string name;
  for (const JsonMember &key : grid.vary)
    name += (name.empty() ? "" : ", ") + last_part(key.key);
  return name;
}

void add_grid(const Study &study, const StudyGrid &grid, std::vector<Case> &cases)
{
  std::vector<std::size_t> digit(grid.vary.size(), 0);
  while (true) {
    Case c;
    c.group = grid_name(grid);
    append(c.overrides, study.set);
    append(c.overrides, grid.set);
    for (std::size_t k = 0; k < digit.size(); ++k) {
      const JsonMember &key = grid.vary[k];
      const JsonValue &value = key.value.elements[digit[k]];
      c.overrides.push_back({key.key, value, value.place});
      c.name += (k == 0 ? "" : ", ") + last_part(key.key) + "=" + value_text(value);
    }
    if (!grid.name.empty())
      c.name = grid.name + ": " + c.name;
    cases.push_back(std::move(c));
    std::size_t k = digit.size();
    while (k > 0 && ++digit[k - 1] == grid.vary[k - 1].value.elements.size())
      digit[--k] = 0;
    if (k == 0)
      return;
  }
}

std::vector<Case> expand(const Study &study)
{
  std::vector<Case> cases;
  for (const StudyGrid &grid : study.grids)
    add_grid(study, grid, cases);
  for (const StudyRow &row : study.rows) {
    Case c;
    c.name = row.name;
    c.rival = row.rival;
    append(c.overrides, study.set);
    append(c.overrides, row.set);
    cases.push_back(std::move(c));
  }
  return cases;
}

std::vector<std::string> varied_keys(const Study &study)
{
  std::vector<std::string> keys;
  const auto add = [&](const std::vector<JsonMember> &members) {
    for (const JsonMember &m : members)
      if (std::find(keys.begin(), keys.end(), m.key) == keys.end())
        keys.push_back(m.key);
  };
  for (const StudyGrid &grid : study.grids) {
    add(grid.vary);
    add(grid.set);
  }
  for (const StudyRow &row : study.rows)
    add(row.set);
  return keys;
}

/// The first thing that is wrong, on one line.
std::string reason(const std::vector<core::Diagnostic> &errors)
{
  const core::Diagnostic &d = errors.front();
  return d.message + (d.reason.empty() ? "" : ": " + d.reason);
}

bool is_referred_to(const Study &study, const Case &c)
{
  return c.group.empty() && (c.name == study.reference || c.name == study.total.reference);
}
} // namespace

CaseList make_cases(const Study &study, const JsonValue &json)
{
  CaseList list;
  list.keys = varied_keys(study);
  list.cases = expand(study);
  std::set<std::string> reported; // the same mistake concerns many cases
  const auto report = [&](const core::Diagnostic &d) {
    if (reported.insert(to_string(d)).second)
      list.errors.push_back(d);
  };
  // A warning has the place of the case's own value, which says nothing new.
  std::set<std::string> warned;
  const auto warn = [&](const core::Diagnostic &d) {
    if (warned.insert(d.key + d.message).second)
      list.warnings.push_back(d);
  };
  std::vector<core::Diagnostic> of_refused;
  bool any = false;
  for (Case &c : list.cases) {
    const ReadResult read = read_scene(study.scene, c.overrides);
    if (read.scene) {
      std::for_each(read.warnings.begin(), read.warnings.end(), warn);
      c.scene = read.resolved;
      // The case's scene lies elsewhere: relative paths in it would lead nowhere.
      if (const std::string &file = read.scene->zone.packing_file; !file.empty())
        c.scene["discrete_zone"]["packing_file"] = std::filesystem::absolute(file).string();
      c.id = text_id(scene_text(c.scene));
      any = true;
      continue;
    }
    c.refused = reason(read.errors);
    if (!read.keys_are_right || is_referred_to(study, c))
      std::for_each(read.errors.begin(), read.errors.end(), report);
    else
      of_refused.insert(of_refused.end(), read.errors.begin(), read.errors.end());
  }
  if (!any && list.errors.empty()) {
    std::for_each(of_refused.begin(), of_refused.end(), report);
    list.errors.push_back({place_of(json, ""), "", "no case of the study can be computed",
                           "each is refused for the reasons above", "correct scene or values"});
  }
  return list;
}

std::string scene_text(const nlohmann::ordered_json &scene)
{
  // Sorted keys: the order in which the table declares them means nothing.
  nlohmann::json sorted = nlohmann::json::parse(scene.dump());
  sorted.erase("title");
  if (sorted.contains("output"))
    sorted["output"].erase("progress_interval");
  return sorted.dump();
}

std::string text_id(const std::string &text)
{
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : text)
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return fmt::format("{:016x}", hash);
}
} // namespace ligament::program
