// Values given on the command line ("--set /path=value") take the place of those in the file.
#pragma once

#include "core/json.h"
#include "core/parameters/parameter_section.h"

namespace ligament::core
{
/// Puts "/path=value" into `json` before it is read; the value is JSON, or a bare word or quantity.
/// Groups of keys on the way are made; a list grows by the index behind its last one, or "-".
/// A wrong path is an error with a suggestion, placed at "--set /path".
void apply_override(const ParameterSection &root, const std::string &text, JsonValue &json,
                    std::vector<Diagnostic> &errors);
} // namespace ligament::core
