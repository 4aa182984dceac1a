// What the table says about its keys: for people, for editors, and as the echo of resolved values.
#pragma once

#include "core/parameters/parameter_section.h"

#include <nlohmann/json.hpp>

namespace ligament::core
{
/// Every value that the variables hold now, defaults included, in SI units; reading it again gives
/// the same variables. Keys that do not apply in the dimension are left out.
nlohmann::ordered_json echo(const ParameterSection &section, int dimension);

/// What is known about one key or section, as lines of text. `key` is a JSON pointer, or the last
/// part of one: then all keys of that name. Empty: everything. The variables must hold their
/// defaults. Throws InputError with a suggestion when there is no such key.
std::string explain(const ParameterSection &root, const std::string &key);

/// The same as JSON: a list of {key, type, unit, default, range, text}.
nlohmann::ordered_json explain_json(const ParameterSection &root, const std::string &key);

/// Tables of all keys in Markdown, one per section; `title` says what the root is.
std::string markdown_tables(const ParameterSection &root, const std::string &title);

/// JSON schema (draft 7) of the input, for editors.
nlohmann::ordered_json schema(const ParameterSection &root);
} // namespace ligament::core
