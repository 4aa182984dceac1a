// Documents drawn from a table of parameters: what it allows, and faults in that.
#pragma once

#include "core/json.h"
#include "core/parameters/parameter_section.h"
#include "tests/fuzz/draw.h"

namespace ligament::fuzz
{
/// Puts a further key at the end of an object.
void add_member(core::JsonValue &object, const std::string &key, const core::JsonValue &value);

/// A document all keys of which are right by the table: numbers within their bounds and bands, as
/// they are or with a unit, words of the lists. Keys without need are left out three times in four.
core::JsonValue draw_document(Draw &draw, const core::ParameterSection &section, int dimension);

/// Gives one key, drawn among all of the section and those below that the document has or may have,
/// another value that the table allows.
void change_key(Draw &draw, const core::ParameterSection &section, int dimension,
                core::JsonValue &document);

/// One fault anywhere in the document: a key lost, twice, misspelt or of another section, a value
/// of another type, an odd number or word, a wrong unit, too many or few elements, or very deep
/// brackets.
void spoil(Draw &draw, core::JsonValue &document);
} // namespace ligament::fuzz
