#include "src/scene/findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

namespace ligament::program
{
namespace
{
bool is_or_holds(const std::string &outer, const std::string &inner)
{
  return inner.compare(0, outer.size(), outer) == 0 &&
         (inner.size() == outer.size() || inner[outer.size()] == '/');
}
} // namespace

Findings::Findings(const core::JsonValue &json, std::vector<core::Diagnostic> &errors,
                   std::vector<core::Diagnostic> &warnings)
    : json_(json), errors_(errors), warnings_(warnings)
{
}

bool Findings::written(const std::string &key) const
{
  const core::JsonValue *value = &json_;
  for (const std::string &part : core::pointer_parts(key)) {
    if (value->is(core::JsonValue::Kind::array)) {
      const std::size_t index = std::strtoul(part.c_str(), nullptr, 10);
      if (index >= value->elements.size())
        return false;
      value = &value->elements[index];
      continue;
    }
    const core::JsonMember *member = value->find(part);
    if (!member)
      return false;
    value = &member->value;
  }
  return !value->is(core::JsonValue::Kind::null);
}

bool Findings::sound(std::initializer_list<std::string> keys) const
{
  return std::none_of(keys.begin(), keys.end(), [&](const std::string &key) {
    return std::any_of(errors_.begin(), errors_.end(), [&](const core::Diagnostic &error) {
      return is_or_holds(error.key, key) || is_or_holds(key, error.key);
    });
  });
}

bool Findings::sound_and_given(std::initializer_list<std::string> keys) const
{
  return sound(keys) &&
         std::all_of(keys.begin(), keys.end(), [&](const std::string &key) { return given(key); });
}

void Findings::error(const std::string &key, const std::string &message, const std::string &reason,
                     const std::string &remedy)
{
  errors_.push_back({core::place_of(json_, key), key, message, reason, remedy});
}

void Findings::warning(const std::string &key, const std::string &message,
                       const std::string &reason, const std::string &remedy)
{
  warnings_.push_back({core::place_of(json_, key), key, message, reason, remedy,
                       core::Diagnostic::Severity::warning});
}

void Findings::unused(const std::string &key, const std::string &reason, const std::string &remedy)
{
  if (!sound_and_given({key}))
    return;
  const auto end = key.rfind('/');
  warning(key,
          fmt::format("\"{}\" in {} is not used", key.substr(end + 1),
                      end == 0 ? "/" : key.substr(0, end)),
          reason, remedy);
}
} // namespace ligament::program
