// Faults in texts of lines and fields, and in any text at all.
#pragma once

#include "tests/fuzz/draw.h"

namespace ligament::fuzz
{
/// One fault in a text whose lines are fields between `separators`: a line lost, twice, swapped
/// with another or cut, a field lost, twice or in place of it something that is no number or an odd
/// one.
std::string with_wrong_line(Draw &draw, const std::string &text, const std::string &separators);

/// One fault in the bytes: the text ends early, bytes are lost, twice, others, or not UTF-8.
std::string with_wrong_bytes(Draw &draw, const std::string &text);
} // namespace ligament::fuzz
