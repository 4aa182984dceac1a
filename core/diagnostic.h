// What is wrong with an input, where, why, and how to put it right.
#pragma once

#include "core/place.h"

#include <string>
#include <vector>

namespace ligament::core
{
struct Diagnostic
{
  enum class Severity
  {
    error,
    warning
  };
  Place place;
  /// JSON pointer of the key it is about, such as /coupling/overlap_cells; where it was misspelt,
  /// of the one that is probably meant.
  std::string key;
  std::string message; // one line
  std::string reason;  // may be empty
  std::string remedy;  // may be empty
  Severity severity = Severity::error;
};

/// "scene.json:14:7: error: message", then the reason and the remedy on lines of their own; control
/// characters of quoted input as \\x1b.
std::string to_string(const Diagnostic &diagnostic);

/// In the order of the file, what came from the command line after it.
void sort_by_place(std::vector<Diagnostic> &diagnostics);
} // namespace ligament::core
