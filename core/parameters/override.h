// Values from elsewhere (the command line, "--set /path=value"; a study) take the place of those in
// the file.
#pragma once

#include "core/json.h"
#include "core/parameters/parameter_section.h"

namespace ligament::core
{
/// A value for the key that a JSON pointer names, and where it was written.
struct Override
{
  std::string pointer;
  JsonValue value;
  Place place;
};

/// Puts the value into `json` before it is read. Groups of keys on the way are made; a list grows
/// by the index behind its last one, or "-". A wrong path is an error with a suggestion.
void apply_override(const ParameterSection &root, const Override &o, JsonValue &json,
                    std::vector<Diagnostic> &errors);

/// Puts "/path=value" into `json`; the value is JSON, or a bare word or quantity. Errors are placed
/// at
/// "--set /path".
void apply_override(const ParameterSection &root, const std::string &text, JsonValue &json,
                    std::vector<Diagnostic> &errors);
} // namespace ligament::core
