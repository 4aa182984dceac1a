#include "core/parameters/override.h"

#include "core/parameters/spelling.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <charconv>
#include <optional>
#include <system_error>

namespace ligament::core
{
namespace
{
using JsonKind = JsonValue::Kind;
using Kind = Parameter::Kind;

void set_origin(JsonValue &value, const Place &place)
{
  value.place = place;
  for (JsonValue &element : value.elements)
    set_origin(element, place);
  for (JsonMember &member : value.members) {
    member.place = place;
    set_origin(member.value, place);
  }
}

bool is_utf8(const std::string &text)
{
  try {
    nlohmann::json(text).dump();
    return true;
  } catch (const nlohmann::json::type_error &) {
    return false;
  }
}

/// JSON where the text is JSON or means to be, else the text itself.
JsonValue value_of(const std::string &text, const Place &place, std::vector<Diagnostic> &errors)
{
  std::vector<Diagnostic> mistakes;
  JsonValue value = parse_json(text, place.origin, mistakes);
  const bool is_json = !text.empty() && (text[0] == '{' || text[0] == '[' || text[0] == '"');
  if (!mistakes.empty() && !is_json) {
    value = {};
    value.kind = JsonKind::string;
    value.text = text;
    mistakes.clear();
    if (!is_utf8(text))
      mistakes.push_back({place, "", "a byte that is not UTF-8", "the resolved scene is JSON",
                          "write the value in UTF-8"});
  }
  for (Diagnostic &mistake : mistakes) {
    mistake.place = place;
    errors.push_back(mistake);
  }
  set_origin(value, place);
  return value;
}

/// Walks table and input along the path of an override.
class Path
{
public:
  Path(const Override &o, std::vector<Diagnostic> &errors)
      : parts_(pointer_parts(o.pointer)), value_(o.value), place_(o.place), errors_(errors)
  {
  }

  void into_section(const ParameterSection &section, JsonValue &json, std::size_t k)
  {
    const Parameter *p = section.find(parts_[k]);
    if (!p) {
      const std::vector<std::string> keys = section.keys(0);
      return error(fmt::format("unknown key \"{}\" in {}{}", parts_[k], path(k),
                               did_you_mean(parts_[k], keys)),
                   "the path must name a key of the scene",
                   "the keys here are " + listed(keys, "and"));
    }
    const bool last = k + 1 == parts_.size();
    if (!last && !p->section && p->kind != Kind::vector && p->kind != Kind::rotation &&
        p->kind != Kind::points)
      return error(fmt::format("\"{}\" in {} has no keys below it", p->key, path(k)),
                   "it is " + p->type(0), "end the path there");
    JsonMember *member = json.find(p->key);
    if (!last && p->kind != Kind::section && !member)
      return error(fmt::format("\"{}\" in {} is not in the file", p->key, path(k)),
                   "only what is there can be reached by its number", "give the whole list");
    if (!json.is(JsonKind::object))
      make_object(section, json);
    member = json.find(p->key);
    if (!member) {
      json.members.push_back({p->key, place_, {}});
      member = &json.members.back();
    }
    if (last)
      assign(*p, *member);
    else if (p->kind == Kind::section)
      into_section(*p->section, member->value, k + 1);
    else
      into_list(*p, member->value, k + 1);
  }

private:
  void error(const std::string &message, const std::string &reason, const std::string &remedy)
  {
    errors_.push_back({place_, path(parts_.size()), message, reason, remedy});
  }

  /// JSON pointer of the first n parts.
  std::string path(std::size_t n) const
  {
    std::string text;
    for (std::size_t k = 0; k < n; ++k)
      text += "/" + parts_[k];
    return text.empty() ? "/" : text;
  }

  void make_object(const ParameterSection &section, JsonValue &json) const
  {
    JsonValue object;
    object.kind = JsonKind::object;
    object.place = json.place.origin.empty() ? place_ : json.place;
    if (json.is(JsonKind::string) && !section.shorthand().empty())
      object.members.push_back({section.shorthand(), json.place, json});
    json = object;
  }

  void assign(const Parameter &p, JsonMember &member)
  {
    if (p.section && !p.section->shorthand().empty() && value_.is(JsonKind::string) &&
        member.value.is(JsonKind::object))
    {
      // The other keys of the section stay: the pure discrete twin needs the packing.
      JsonMember *word = member.value.find(p.section->shorthand());
      if (!word) {
        member.value.members.push_back({p.section->shorthand(), place_, {}});
        word = &member.value.members.back();
      }
      *word = {word->key, place_, value_};
      return;
    }
    member.place = place_;
    member.value = value_;
  }

  void into_list(const Parameter &p, JsonValue &json, std::size_t k)
  {
    const std::string &part = parts_[k];
    std::size_t index = 0;
    const auto [end, failed] = std::from_chars(part.data(), part.data() + part.size(), index);
    const bool is_index = failed == std::errc() && end == part.data() + part.size();
    const bool grows = p.kind != Kind::vector && p.kind != Kind::rotation;
    if (part == "-" && grows)
      index = json.elements.size();
    else if (!is_index || index > json.elements.size() - (grows ? 0 : 1) || json.elements.empty())
      return error(fmt::format("there is no element \"{}\" in {}", part, path(k)),
                   fmt::format("it has {} elements, counted from 0", json.elements.size()),
                   grows ? "write - to add one" : "give a number below that");
    const bool last = k + 1 == parts_.size();
    if (last && index < json.elements.size())
      json.elements[index] = value_;
    else if (last)
      json.elements.push_back(value_);
    else if (index == json.elements.size())
      error(fmt::format("{} has no element {} yet", path(k), index),
            "a new element is given as a whole", "end the path there and give the element");
    else if (p.kind == Kind::list)
      into_section(*p.section, json.elements[index], k + 1);
    else if (p.kind == Kind::points && k + 2 == parts_.size())
      into_point(json.elements[index]);
    else
      error(fmt::format("{} has no keys below it", path(k + 1)), "it is a number",
            "end the path there");
  }

  void into_point(JsonValue &json)
  {
    Parameter component;
    component.kind = Kind::vector;
    into_list(component, json, parts_.size() - 1);
  }

  std::vector<std::string> parts_;
  JsonValue value_;
  Place place_;
  std::vector<Diagnostic> &errors_;
};
} // namespace

void apply_override(const ParameterSection &root, const Override &o, JsonValue &json,
                    std::vector<Diagnostic> &errors)
{
  if (o.pointer.size() < 2 || o.pointer[0] != '/')
    errors.push_back(
        {o.place, "", fmt::format("cannot read \"{}\" as the path of a key", o.pointer),
         "a key of the scene is named by its path", "write for example /coupling/overlap_cells"});
  else
    Path(o, errors).into_section(root, json, 0);
}

void apply_override(const ParameterSection &root, const std::string &text, JsonValue &json,
                    std::vector<Diagnostic> &errors)
{
  const std::size_t equals = text.find('=');
  const std::string pointer = text.substr(0, equals);
  const Place place{"--set " + pointer};
  if (equals == std::string::npos || pointer.size() < 2 || pointer[0] != '/') {
    errors.push_back({place, "", fmt::format("cannot read \"{}\"", text),
                      "an override names a key by its path and gives its value",
                      "write for example --set /coupling/overlap_cells=4"});
    return;
  }
  const JsonValue value = value_of(text.substr(equals + 1), place, errors);
  apply_override(root, Override{pointer, value, place}, json, errors);
}
} // namespace ligament::core
