#include "core/json.h"

#include <nlohmann/json.hpp>

#include <charconv>
#include <system_error>
#include <utility>

namespace ligament::core
{
using Kind = JsonValue::Kind;

const JsonMember *JsonValue::find(std::string_view key) const
{
  for (const JsonMember &member : members)
    if (member.key == key)
      return &member;
  return nullptr;
}

JsonMember *JsonValue::find(std::string_view key)
{
  return const_cast<JsonMember *>(std::as_const(*this).find(key));
}

std::string name_of(JsonValue::Kind kind)
{
  switch (kind) {
  case Kind::null:
    return "null";
  case Kind::boolean:
    return "true or false";
  case Kind::number:
    return "a number";
  case Kind::string:
    return "a string";
  case Kind::array:
    return "a list [..]";
  case Kind::object:
    return "an object {..}";
  }
  return "";
}

std::string to_text(const JsonValue &value)
{
  const auto quoted = [](const std::string &text) {
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  };
  std::string text;
  switch (value.kind) {
  case JsonValue::Kind::null:
    return "null";
  case JsonValue::Kind::boolean:
    return value.boolean ? "true" : "false";
  case JsonValue::Kind::number:
    return value.text;
  case JsonValue::Kind::string:
    return quoted(value.text);
  case JsonValue::Kind::array:
    for (const JsonValue &element : value.elements)
      text += (text.empty() ? "" : ", ") + to_text(element);
    return "[" + text + "]";
  case JsonValue::Kind::object:
    for (const JsonMember &member : value.members)
      text += (text.empty() ? "" : ", ") + quoted(member.key) + ": " + to_text(member.value);
    return "{" + text + "}";
  }
  return text;
}

std::vector<std::string> pointer_parts(std::string_view pointer)
{
  std::vector<std::string> parts;
  for (std::size_t k = 0; k < pointer.size(); ++k)
    if (pointer[k] == '/' || parts.empty()) {
      parts.emplace_back();
      if (pointer[k] != '/')
        parts.back() += pointer[k];
    } else if (pointer[k] == '~' && k + 1 < pointer.size() &&
               (pointer[k + 1] == '0' || pointer[k + 1] == '1'))
      parts.back() += pointer[++k] == '0' ? '~' : '/';
    else
      parts.back() += pointer[k];
  return parts;
}

Place place_of(const JsonValue &root, std::string_view pointer)
{
  const JsonValue *value = &root;
  Place place = root.place;
  for (const std::string &part : pointer_parts(pointer)) {
    if (const JsonMember *member = value->find(part)) {
      place = member->place;
      value = &member->value;
      continue;
    }
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
    if (error != std::errc() || end != part.data() + part.size() || index >= value->elements.size())
      break;
    value = &value->elements[index];
    place = value->place;
  }
  return place;
}
} // namespace ligament::core
