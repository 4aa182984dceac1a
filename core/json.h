// JSON with comments, read so that every key and value knows its line and column.
#pragma once

#include "core/diagnostic.h"

#include <string>
#include <string_view>
#include <vector>

namespace ligament::core
{
struct JsonMember;

/// One value as it was written. Output is written with nlohmann-json; this type exists for input,
/// where positions and repeated keys matter.
struct JsonValue
{
  enum class Kind
  {
    null,
    boolean,
    number,
    string,
    array,
    object
  };
  Kind kind = Kind::null;
  Place place; // first character of the value
  bool boolean = false;
  double number = 0;
  std::string text; // of a string; of a number: as it was written
  std::vector<JsonValue> elements;
  std::vector<JsonMember> members; // in the order of the file

  bool is(Kind k) const { return kind == k; }
  /// The member with this key, or a null pointer.
  const JsonMember *find(std::string_view key) const;
  JsonMember *find(std::string_view key);
};

struct JsonMember
{
  std::string key;
  Place place; // opening quote of the key
  JsonValue value;
};

/// "a number", "an object", ...
std::string name_of(JsonValue::Kind kind);

/// Reads text in UTF-8 with // and /* */ comments. Mistakes are added to `errors`: reading stops at
/// the first one of syntax; a repeated key is reported and its first value is kept.
JsonValue parse_json(std::string_view text, const std::string &origin,
                     std::vector<Diagnostic> &errors);

/// The value as JSON on one line; numbers as they were written.
std::string to_text(const JsonValue &value);

/// Parts of a JSON pointer ("/loads/0/ramp"), with ~1 and ~0 decoded.
std::vector<std::string> pointer_parts(std::string_view pointer);

/// Place of what the pointer names, or of the deepest part of it that was written.
Place place_of(const JsonValue &root, std::string_view pointer);
} // namespace ligament::core
