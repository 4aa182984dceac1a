// The commented scenes that `ligament new` writes: the files in src/launcher/new, kept in the
// program.
#pragma once

#include <string>
#include <vector>

namespace ligament::program
{
struct SceneKind
{
  std::string name; // of its file
  std::string text; // the whole file; the first line is a comment that says what it is
};

/// All of them, in the order of the alphabet.
std::vector<SceneKind> scene_kinds();

/// What the first line of the file says.
std::string summary(const SceneKind &kind);

/// One line per kind, for help and for `ligament new` alone.
std::string list_of_kinds();
} // namespace ligament::program
