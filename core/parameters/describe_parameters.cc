#include "core/parameters/describe_parameters.h"

#include "core/check.h"
#include "core/parameters/spelling.h"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <set>

namespace ligament::core
{
namespace
{
using Json = nlohmann::ordered_json;
using Kind = Parameter::Kind;
using Necessity = Parameter::Necessity;

int components_in(int dimension)
{
  return dimension == 0 ? 2 : dimension;
}

/// A number, or the word or null that stands for it.
Json number_json(const Parameter &p, double value)
{
  for (const auto &word : p.words)
    if (word.second == value)
      return word.first;
  if (p.null_value && value == *p.null_value)
    return nullptr;
  return value;
}

Json point_json(const Parameter &p, const Point &point, int dimension)
{
  Json list = Json::array();
  for (int c = 0; c < components_in(dimension); ++c)
    list.push_back(number_json(p, point[c]));
  return list;
}

Json value_json(const Parameter &p, int dimension)
{
  const bool unset_is_null = p.necessity == Necessity::conditional;
  if (auto *x = std::get_if<double *>(&p.target))
    return unset_is_null && **x == 0 ? Json() : number_json(p, **x);
  if (auto *x = std::get_if<int *>(&p.target))
    return **x;
  if (auto *x = std::get_if<bool *>(&p.target))
    return **x;
  if (auto *x = std::get_if<std::string *>(&p.target))
    return unset_is_null && (*x)->empty() ? Json() : Json(**x);
  if (auto *x = std::get_if<std::optional<double> *>(&p.target))
    return **x ? Json(***x) : Json();
  if (auto *x = std::get_if<Choice>(&p.target))
    return x->get() < 0 ? Json() : Json(p.choices[x->get()]);
  if (auto *x = std::get_if<Point *>(&p.target))
    return p.kind == Kind::rotation && dimension == 2 ? Json((**x)[0])
                                                      : point_json(p, **x, dimension);
  if (auto *x = std::get_if<PartialPoint *>(&p.target)) {
    Json list = Json::array();
    bool any = false;
    for (int c = 0; c < components_in(dimension); ++c) {
      list.push_back((**x)[c] ? Json(*(**x)[c]) : Json());
      any = any || (**x)[c];
    }
    return any ? list : Json();
  }
  if (auto *x = std::get_if<std::vector<JsonMember> *>(&p.target)) {
    Json object = Json::object();
    for (const JsonMember &member : **x)
      object[member.key] = Json::parse(to_text(member.value));
    return object;
  }
  Json list = Json::array();
  if (auto *x = std::get_if<std::vector<NumberPair> *>(&p.target))
    for (const NumberPair &pair : **x)
      list.push_back(pair);
  if (auto *x = std::get_if<std::vector<Point> *>(&p.target))
    for (const Point &point : **x)
      list.push_back(point_json(p, point, dimension));
  return list;
}

/// Default as it would be written; empty for keys that must be given and for sections.
std::string default_text(const Parameter &p)
{
  if (p.must_be_given(p.only_dimension))
    return "required";
  if (p.necessity == Necessity::conditional)
    return "required " + p.condition;
  if (p.kind == Kind::ignored || (p.kind == Kind::section && p.absent_word.empty()))
    return "";
  if (p.kind == Kind::section || p.kind == Kind::list)
    return p.kind == Kind::list ? "[]" : "\"" + p.absent_word + "\"";
  if (p.kind == Kind::rotation)
    return "no rotation";
  const Json value = value_json(p, 0);
  if (value.is_null())
    return "not set";
  return value.dump();
}

struct Found
{
  std::string path;
  const Parameter *parameter;
};

void collect(const ParameterSection &section, const std::string &path, std::vector<Found> &all)
{
  for (const Parameter &p : section.parameters()) {
    all.push_back({path + "/" + p.key, &p});
    if (p.section)
      collect(*p.section, path + "/" + p.key + (p.kind == Kind::list ? "/*" : ""), all);
  }
}

/// /loads/0/ramp and /loads/*/ramp and loads.ramp name the same key.
std::string plain(const std::string &path)
{
  std::string text;
  std::string part;
  for (const char c : path + "/")
    if (c != '/' && c != '.')
      part += c;
    else {
      if (!part.empty() && part != "*" && part.find_first_not_of("0123456789") != part.npos)
        text += "/" + part;
      part.clear();
    }
  return text;
}

std::string lower_case(std::string text)
{
  for (char &c : text)
    c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// Where else to look for a topic: the keys whose texts or values name it.
std::string that_speak_of(const std::string &topic, const std::vector<Found> &all)
{
  std::vector<std::string> keys;
  for (const Found &f : all) {
    std::string text = f.parameter->text;
    for (const std::string &word : f.parameter->choices)
      text += " " + word;
    if (keys.size() < 5 && topic.size() > 2 &&
        lower_case(text).find(lower_case(topic)) != text.npos)
      keys.push_back(f.path);
  }
  return keys.empty() ? ", and none that speaks of it: a scene has no such thing"
                      : "; these speak of it: " + listed(keys, "and");
}

std::vector<Found> select(const ParameterSection &root, const std::string &key)
{
  std::vector<Found> all, selected;
  collect(root, "", all);
  const std::string wanted = plain(key);
  const bool is_path = wanted.find('/', 1) != wanted.npos;
  for (const Found &f : all) {
    const std::string path = plain(f.path);
    const bool below = path.compare(0, wanted.size() + 1, wanted + "/") == 0;
    if (wanted.empty() || path == wanted || below || (!is_path && "/" + f.parameter->key == wanted))
      selected.push_back(f);
  }
  if (selected.empty()) {
    std::vector<std::string> names;
    std::set<std::string> seen;
    for (const Found &f : all)
      for (const std::string &name : {plain(f.path), f.parameter->key})
        if (seen.insert(name).second)
          names.push_back(name);
    const std::string meant = did_you_mean(is_path ? wanted : wanted.substr(1), names);
    throw InputError(fmt::format("there is no key \"{}\"{}", key,
                                 meant.empty() ? that_speak_of(key, all) : meant));
  }
  return selected;
}

Json bounds_schema(const Parameter &p, const char *type)
{
  Json number = {{"type", type}};
  if (p.lower)
    number[p.lower->open ? "exclusiveMinimum" : "minimum"] = p.lower->value;
  if (p.upper)
    number[p.upper->open ? "exclusiveMaximum" : "maximum"] = p.upper->value;
  return number;
}

/// A number in SI, or text that starts with a number.
Json number_schema(const Parameter &p)
{
  Json any = Json::array(
      {bounds_schema(p, "number"), Json{{"type", "string"}, {"pattern", "^ *[-+]?[0-9.]"}}});
  if (!p.words.empty()) {
    Json words = Json::array();
    for (const auto &word : p.words)
      words.push_back(word.first);
    any.push_back({{"enum", words}});
  }
  return {{"anyOf", any}};
}

Json vector_schema(const Parameter &p)
{
  Json item = number_schema(p);
  if (p.null_value || std::holds_alternative<PartialPoint *>(p.target))
    item["anyOf"].push_back({{"type", "null"}});
  return {{"type", "array"}, {"items", item}, {"minItems", 2}, {"maxItems", 3}};
}

Json section_schema(const ParameterSection &section);

Json value_schema(const Parameter &p)
{
  switch (p.kind) {
  case Kind::ignored:
    return Json::object();
  case Kind::number:
    return number_schema(p);
  case Kind::integer:
    return bounds_schema(p, "integer");
  case Kind::boolean:
    return {{"type", "boolean"}};
  case Kind::string:
    return {{"type", "string"}};
  case Kind::choice:
    return {{"enum", p.choices}};
  case Kind::vector:
    return vector_schema(p);
  case Kind::rotation: {
    Json any = number_schema(p);
    any["anyOf"].push_back(vector_schema(p));
    return any;
  }
  case Kind::points:
    return {{"type", "array"}, {"items", vector_schema(p)}};
  case Kind::table: {
    const Json pair = {{"type", "array"},
                       {"items", Json::array({number_schema(p), Json{{"type", "number"}}})},
                       {"minItems", 2},
                       {"maxItems", 2}};
    return {{"type", "array"}, {"items", pair}};
  }
  case Kind::members:
    return {{"type", "object"}};
  case Kind::list:
    return {{"type", "array"}, {"items", section_schema(*p.section)}};
  case Kind::section:
    break;
  }
  Json any = Json::array({section_schema(*p.section)});
  if (!p.absent_word.empty())
    any.push_back({{"enum", Json::array({p.absent_word})}});
  if (const std::string &key = p.section->shorthand(); !key.empty())
    any.push_back({{"enum", p.section->find(key)->choices}});
  return any.size() == 1 ? any[0] : Json{{"anyOf", any}};
}

Json section_schema(const ParameterSection &section)
{
  Json properties = Json::object();
  Json required = Json::array();
  for (const Parameter &p : section.parameters()) {
    Json property = value_schema(p);
    std::string text = p.text;
    if (!p.unit_name.empty())
      text += " [" + p.unit_name + "]";
    if (const std::string value = default_text(p); !value.empty())
      text += (value.compare(0, 8, "required") == 0 ? "; " : "; default ") + value;
    property["description"] = text;
    properties[p.key] = property;
    if (p.must_be_given(0))
      required.push_back(p.key);
  }
  Json schema = {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
  if (!required.empty())
    schema["required"] = required;
  return schema;
}

/// Bars separate the columns of a table.
std::string cell(const std::string &text)
{
  std::string safe;
  for (const char c : text)
    safe += c == '|' ? "\\|" : std::string(1, c);
  return safe;
}

void table(const ParameterSection &section, const std::string &path, const std::string &text,
           std::string &out)
{
  out += fmt::format("\n## {}\n\n{}.\n\n", path.empty() ? "/" : "`" + path + "`", text);
  if (!section.shorthand().empty())
    out += fmt::format("A bare word stands for `{{\"{}\": word}}`.\n\n", section.shorthand());
  out += "| key | type | default | allowed | usual | meaning |\n|---|---|---|---|---|---|\n";
  for (const Parameter &p : section.parameters())
    out += fmt::format("| `{}` | {} | {} | {} | {} | {}{} |\n", p.key, cell(p.type(0)),
                       cell(default_text(p)), p.range(), p.usual_range(), cell(p.text),
                       p.only_dimension == 0 ? "" : fmt::format(" ({}D)", p.only_dimension));
  for (const Parameter &p : section.parameters())
    if (p.section)
      table(*p.section, path + "/" + p.key + (p.kind == Kind::list ? "/*" : ""), p.text, out);
}
} // namespace

Json echo(const ParameterSection &section, int dimension)
{
  Json json = Json::object();
  for (const Parameter &p : section.parameters()) {
    if (p.kind == Kind::ignored || !p.applies_in(dimension))
      continue;
    Json &value = json[p.key];
    if (p.kind == Kind::section && p.absent_word.empty())
      value = echo(*p.section, dimension);
    else if (p.kind == Kind::section && p.elements.size() == 0)
      value = p.absent_word;
    else if (p.kind == Kind::section) {
      p.elements.load(0);
      value = echo(*p.section, dimension);
    } else if (p.kind == Kind::list) {
      value = Json::array();
      for (std::size_t k = 0; k < p.elements.size(); ++k) {
        p.elements.load(k);
        value.push_back(echo(*p.section, dimension));
      }
    } else
      value = value_json(p, dimension);
  }
  return json;
}

std::string explain(const ParameterSection &root, const std::string &key)
{
  std::string text;
  for (const Found &f : select(root, key)) {
    const Parameter &p = *f.parameter;
    const auto line = [&](const char *name, const std::string &value) {
      if (!value.empty())
        text += fmt::format("  {:<8} {}\n", name, value);
    };
    text += fmt::format("{}{}\n", text.empty() ? "" : "\n", f.path);
    line("meaning", p.text);
    line("type", p.type(0));
    line("unit", p.unit_name);
    line("default", default_text(p));
    line("allowed", p.range());
    line("usual", p.usual_range());
    if (p.only_dimension != 0)
      line("applies", fmt::format("in {}D", p.only_dimension));
  }
  return text;
}

Json explain_json(const ParameterSection &root, const std::string &key)
{
  Json list = Json::array();
  for (const Found &f : select(root, key)) {
    const Parameter &p = *f.parameter;
    list.push_back({{"key", f.path},
                    {"type", p.type(0)},
                    {"unit", p.unit_name},
                    {"default", default_text(p)},
                    {"range", p.range()},
                    {"usual", p.usual_range()},
                    {"text", p.text}});
  }
  return list;
}

std::string markdown_tables(const ParameterSection &root, const std::string &title)
{
  std::string out;
  table(root, "", title, out);
  return out;
}

Json schema(const ParameterSection &root)
{
  Json json = {{"$schema", "http://json-schema.org/draft-07/schema#"}};
  const Json keys = section_schema(root);
  for (const auto &item : keys.items())
    json[item.key()] = item.value();
  return json;
}
} // namespace ligament::core
