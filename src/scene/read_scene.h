// From a scene file to checked values, or to everything that is wrong with it.
#pragma once

#include "core/diagnostic.h"
#include "core/parameters/override.h"
#include "src/scene/scene.h"

#include <nlohmann/json.hpp>

namespace ligament::program
{
struct ReadResult
{
  std::optional<Scene> scene; // without value when there are errors
  std::vector<core::Diagnostic> errors, warnings;
  std::string text;     // as it was read
  core::JsonValue json; // with the overrides: where each key stands
  /// Keys, types and bounds are right; what may be wrong then is how values go together.
  bool keys_are_right = false;
  /// Every value, defaults included, in SI units; reading it gives the same scene. Null with
  /// errors.
  nlohmann::ordered_json resolved;
};

/// What messages call the scene: its path, or "standard input" for "-".
std::string scene_name(const std::string &file);

/// Reads the file (JSON with comments; a pipe, or standard input for "-"), applies the overrides
/// ("/path=value") in their order and checks everything that can be checked without building the
/// bodies. Does not throw for wrong input.
ReadResult read_scene(const std::string &file, const std::vector<std::string> &overrides = {});

/// The same with values that were read elsewhere; their places appear in the messages.
ReadResult read_scene(const std::string &file, const std::vector<core::Override> &overrides);

/// The same for text; `name` is its name in messages.
ReadResult parse_scene(const std::string &text, const std::string &name,
                       const std::vector<std::string> &overrides = {});

/// The figures of one key or section ("/coupling/overlap_cells", "overlap_cells"), or of all keys
/// when it is empty; as text, and as a JSON list. Throws core::InputError with a suggestion when
/// there is no such key.
std::string explain(const std::string &key);
nlohmann::ordered_json explain_json(const std::string &key);

/// JSON schema of scene files, for editors.
nlohmann::ordered_json json_schema();

/// The parameter reference of the manual, in Markdown.
std::string reference_markdown();
} // namespace ligament::program
