#include "core/diagnostic.h"

#include <algorithm>
#include <tuple>

namespace ligament::core
{
std::string to_string(const Diagnostic &d)
{
  std::string text = to_string(d.place);
  text += d.severity == Diagnostic::Severity::error ? ": error: " : ": warning: ";
  text += d.message;
  if (!d.reason.empty())
    text += "\n  reason: " + d.reason;
  if (!d.remedy.empty())
    text += "\n  remedy: " + d.remedy;
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
