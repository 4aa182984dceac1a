#include "tests/fuzz/scene_grammar.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace ligament::fuzz
{
namespace
{
using core::JsonValue;
using core::Parameter;
using core::ParameterSection;
using JsonKind = JsonValue::Kind;
using Kind = Parameter::Kind;

JsonValue word(const std::string &text)
{
  JsonValue value;
  value.kind = JsonKind::string;
  value.text = text;
  return value;
}

JsonValue number(const std::string &text)
{
  JsonValue value;
  value.kind = JsonKind::number;
  value.text = text;
  return value;
}

JsonValue boolean(bool b)
{
  JsonValue value;
  value.kind = JsonKind::boolean;
  value.boolean = b;
  return value;
}

JsonValue array(std::vector<JsonValue> elements)
{
  JsonValue value;
  value.kind = JsonKind::array;
  value.elements = std::move(elements);
  return value;
}

bool allows(const Parameter &p, double x)
{
  return !(p.lower && (p.lower->open ? x <= p.lower->value : x < p.lower->value)) &&
         !(p.upper && (p.upper->open ? x >= p.upper->value : x > p.upper->value)) &&
         (!p.band || p.band->is_within_reason(x));
}

/// In SI units; mostly what is usual, at times a bound itself.
double draw_number(Draw &draw, const Parameter &p)
{
  for (int attempt = 0; attempt < 100; ++attempt) {
    double x = 0;
    if (p.lower && draw.once_in(20))
      x = p.lower->value;
    else if (p.upper && draw.once_in(20))
      x = p.upper->value;
    else if (p.band)
      x = draw.spread(std::max(p.band->low, 1e-6 * p.band->high), p.band->high);
    else if (p.lower && p.upper)
      x = draw.uniform(p.lower->value, p.upper->value);
    else if (!draw.once_in(10))
      x = draw.spread(1e-3, 1e3) + (p.lower ? p.lower->value : 0);
    if (!p.lower && draw.once_in(2))
      x = -x;
    if (allows(p, x))
      return x;
  }
  throw std::logic_error("no value found for " + p.key + ": " + p.range());
}

JsonValue draw_quantity(Draw &draw, const Parameter &p)
{
  if (!p.words.empty() && draw.once_in(4))
    return word(p.words.begin()->first);
  const double x = draw_number(draw, p);
  if (draw.once_in(2))
    return number(fmt::format("{}", x));
  std::vector<std::string> units = {p.unit_name};
  if (p.band)
    units.insert(units.end(), p.band->units.begin(), p.band->units.end());
  const std::string unit = draw.of(units);
  const std::string text = unit.empty()
                               ? fmt::format("{}", x)
                               : fmt::format("{:.6g} {}", x / core::parse_unit(unit).value, unit);
  // Rounding may leave the bounds.
  return allows(p, core::parse_quantity(text).value) ? word(text) : number(fmt::format("{}", x));
}

JsonValue draw_components(Draw &draw, const Parameter &p, int dimension)
{
  const bool may_be_null = p.null_value || std::holds_alternative<core::PartialPoint *>(p.target);
  std::vector<JsonValue> components;
  for (int c = 0; c < dimension; ++c)
    components.push_back(may_be_null && draw.once_in(4) ? JsonValue() : draw_quantity(draw, p));
  return array(std::move(components));
}

std::string draw_word(Draw &draw)
{
  static const std::vector<std::string> words = {"left", "right", "top",    "bottom", "front",
                                                 "back", "rim",   "punch",  "a",      "b",
                                                 "Cu",   "Ni",    "no.msh", "no.csv", "ä ö"};
  return draw.of(words);
}

JsonValue draw_value(Draw &draw, const Parameter &p, int dimension)
{
  std::vector<JsonValue> list;
  switch (p.kind) {
  case Kind::ignored:
    return word(draw_word(draw));
  case Kind::number:
    return draw_quantity(draw, p);
  case Kind::integer: {
    const int low = p.lower ? int(p.lower->value) + p.lower->open : -5;
    const int high = p.upper ? int(p.upper->value) - p.upper->open : low + 20;
    return number(
        std::to_string(draw.between(low, draw.once_in(3) ? high : std::min(high, low + 5))));
  }
  case Kind::boolean:
    return boolean(draw.once_in(2));
  case Kind::string:
    return word(draw_word(draw));
  case Kind::choice:
    return word(draw.of(p.choices));
  case Kind::rotation:
    if (dimension == 2)
      return draw_quantity(draw, p);
    [[fallthrough]];
  case Kind::vector:
    return draw_components(draw, p, dimension);
  case Kind::points:
    for (int n = draw.between(0, 5); n > 0; --n)
      list.push_back(draw_components(draw, p, dimension));
    return array(std::move(list));
  case Kind::table:
    for (int n = draw.between(0, 5); n > 0; --n)
      list.push_back(
          array({draw_quantity(draw, p), number(fmt::format("{}", draw.uniform(-2, 2)))}));
    return array(std::move(list));
  case Kind::members: {
    JsonValue object;
    object.kind = JsonKind::object;
    return object;
  }
  case Kind::section:
    if (!p.absent_word.empty() && draw.once_in(4))
      return word(p.absent_word);
    return draw_document(draw, *p.section, dimension);
  case Kind::list:
    for (int n = draw.between(0, 3); n > 0; --n)
      list.push_back(draw_document(draw, *p.section, dimension));
    return array(std::move(list));
  }
  return {};
}

/// All values of the document, those inside of others too.
void collect(JsonValue &value, std::vector<JsonValue *> &all)
{
  all.push_back(&value);
  for (JsonValue &element : value.elements)
    collect(element, all);
  for (core::JsonMember &member : value.members)
    collect(member.value, all);
}

/// Has an object or list with content, drawn among all of the document; null without any.
JsonValue *draw_full(Draw &draw, JsonValue &document, bool object)
{
  std::vector<JsonValue *> all;
  collect(document, all);
  all.erase(std::remove_if(all.begin(), all.end(),
                           [&](const JsonValue *v) {
                             return object ? v->members.empty() : v->elements.empty();
                           }),
            all.end());
  return all.empty() ? nullptr : draw.of(all);
}

std::string misspelt(Draw &draw, std::string key)
{
  if (key.empty() || draw.once_in(5))
    return odd_word(draw);
  const std::size_t k = draw.below(key.size());
  draw.once_in(2) ? key.erase(k, 1) : key.insert(k, 1, char('a' + draw.below(26)));
  return key;
}

void spoil_member(Draw &draw, JsonValue &object, JsonValue &document)
{
  auto &members = object.members;
  const std::size_t k = draw.below(members.size());
  switch (draw.below(4)) {
  case 0:
    members.erase(members.begin() + k);
    break;
  case 1:
    members.insert(members.begin() + draw.below(members.size()), core::JsonMember(members[k]));
    break;
  case 2:
    members[k].key = misspelt(draw, members[k].key);
    break;
  default: // from another section
    if (const JsonValue *other = draw_full(draw, document, true))
      members.push_back(core::JsonMember(draw.of(other->members)));
  }
}

void spoil_list(Draw &draw, JsonValue &list)
{
  auto &elements = list.elements;
  const std::size_t k = draw.below(elements.size());
  switch (draw.below(3)) {
  case 0:
    elements.erase(elements.begin() + k);
    break;
  case 1:
    elements.insert(elements.begin() + k, draw.between(1, 4), JsonValue(elements[k]));
    break;
  default:
    std::swap(elements[k], elements[draw.below(elements.size())]);
  }
}

JsonValue deep(Draw &draw)
{
  JsonValue value = number("1");
  for (int n = draw.between(1, 80); n > 0; --n)
    value = array({value});
  return value;
}

JsonValue foreign_value(Draw &draw, JsonValue &document)
{
  static const std::vector<std::string> units = {
      "m", "mm",     "s", "Pa",  "GPa", "deg", "%",    "m^2", "1/s",     "foo",
      "K", "kg/m^3", "",  "m/s", "*",   "m^",  "m^-3", "N/m", "MPa*m^.5"};
  std::vector<JsonValue *> all;
  switch (draw.below(8)) {
  case 0:
    return {};
  case 1:
    return boolean(draw.once_in(2));
  case 2:
    return word(odd_word(draw));
  case 3:
    return number(odd_number(draw));
  case 4:
    return word(odd_number(draw) + (draw.once_in(3) ? "" : " ") + draw.of(units));
  case 5:
    return deep(draw);
  case 6:
    return array({});
  default:
    collect(document, all);
    return *draw.of(all);
  }
}
} // namespace

void add_member(JsonValue &object, const std::string &key, const JsonValue &value)
{
  core::JsonMember &member = object.members.emplace_back();
  member.key = key;
  member.value = value;
}

JsonValue draw_document(Draw &draw, const ParameterSection &section, int dimension)
{
  JsonValue object;
  object.kind = JsonKind::object;
  for (const Parameter &p : section.parameters())
    if (p.applies_in(dimension) && (p.must_be_given(dimension) || draw.once_in(4)))
      add_member(object, p.key, draw_value(draw, p, dimension));
  if (!section.shorthand().empty() && draw.once_in(4) && object.find(section.shorthand()))
    return object.find(section.shorthand())->value;
  return object;
}

void change_key(Draw &draw, const ParameterSection &section, int dimension, JsonValue &document)
{
  std::vector<const Parameter *> keys;
  for (const Parameter &p : section.parameters())
    if (p.applies_in(dimension))
      keys.push_back(&p);
  const Parameter &p = *draw.of(keys);
  if (!document.is(JsonKind::object))
    return;
  core::JsonMember *member = document.find(p.key);
  if (member && p.section && member->value.is(JsonKind::object) && !draw.once_in(10))
    change_key(draw, *p.section, dimension, member->value);
  else if (member && p.kind == Kind::list && !member->value.elements.empty() && !draw.once_in(5))
    change_key(draw, *p.section, dimension,
               member->value.elements[draw.below(member->value.elements.size())]);
  else if (member && p.kind == Kind::number && member->value.is(JsonKind::number) &&
           !draw.once_in(3)) // near what it was: most such scenes are still sound
    member->value = number(fmt::format("{}", member->value.number * draw.uniform(0.5, 2)));
  else if (member)
    member->value = draw_value(draw, p, dimension);
  else
    add_member(document, p.key, draw_value(draw, p, dimension));
}

void spoil(Draw &draw, JsonValue &document)
{
  if (draw.once_in(3)) {
    if (JsonValue *object = draw_full(draw, document, true))
      return spoil_member(draw, *object, document);
  } else if (draw.once_in(4)) {
    if (JsonValue *list = draw_full(draw, document, false))
      return spoil_list(draw, *list);
  }
  std::vector<JsonValue *> all;
  collect(document, all);
  // The root itself is seldom worth it: one mistake then hides all others.
  JsonValue &value = *all[draw.once_in(50) ? 0 : draw.below(all.size())];
  value = foreign_value(draw, document);
}
} // namespace ligament::fuzz
