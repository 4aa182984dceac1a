#include "core/diagnostic.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace ligament::core
{
namespace
{
/// Quoted input may hold what moves the cursor or ends the line: it is shown as its code.
std::string printable(const std::string &text)
{
  std::string shown;
  for (const char c : text)
    if (const auto code = static_cast<unsigned char>(c); code < 0x20 || code == 0x7F)
      shown += fmt::format("\\x{:02x}", code);
    else
      shown += c;
  return shown;
}
} // namespace

std::string to_string(const Diagnostic &d)
{
  std::string text = to_string(d.place);
  text += d.severity == Diagnostic::Severity::error ? ": error: " : ": warning: ";
  text += printable(d.message);
  if (!d.reason.empty())
    text += "\n  reason: " + printable(d.reason);
  if (!d.remedy.empty())
    text += "\n  remedy: " + printable(d.remedy);
  return text;
}

void sort_by_place(std::vector<Diagnostic> &diagnostics)
{
  const auto rank = [](const Diagnostic &d) {
    return std::make_tuple(d.place.line == 0, d.place.line, d.place.column);
  };
  std::stable_sort(diagnostics.begin(), diagnostics.end(),
                   [&](const Diagnostic &a, const Diagnostic &b) { return rank(a) < rank(b); });
}
} // namespace ligament::core
