// Messages for the one who waits at the terminal.
#pragma once

#include <cstdio>
#include <string_view>

namespace ligament::core
{
/// Writes to a stream of the terminal. What cannot be written there is lost without harm; `stream`
/// may be null.
void tell(std::FILE *stream, std::string_view text) noexcept;
} // namespace ligament::core
