// The cases of a study, each with its resolved scene, before anything is computed.
#pragma once

#include "core/parameters/override.h"
#include "src/sweep/study.h"

#include <nlohmann/json.hpp>

namespace ligament::program
{
struct Case
{
  std::string name;  // of the row, or from the values of the grid
  std::string group; // name of the grid; empty for rows
  bool rival = false;
  std::vector<core::Override> overrides;

  /// Every value of the scene; null when it is refused.
  nlohmann::ordered_json scene;
  /// Names the scene: equal scenes have the same id, on any machine.
  std::string id;
  std::string refused; // why this combination of values is no scene; else empty
};

struct CaseList
{
  std::vector<Case> cases;
  std::vector<std::string> keys; // of the scene that grids vary or set, or rows set, in their order
  std::vector<core::Diagnostic> errors;
  std::vector<core::Diagnostic> warnings; // of scenes that are computed, each one once
};

/// All cases in the order of the study: grids (the last key varies fastest), then rows. Wrong keys,
/// types and bounds are errors of the study; values that are right each but do not go together make
/// a refused case, unless it is the reference or there is no other.
CaseList make_cases(const Study &study, const core::JsonValue &json);

/// The scene as text that is the same for the same computation: title and progress are left out.
std::string scene_text(const nlohmann::ordered_json &scene);

/// 16 hexadecimal digits of this text (FNV-1a, 64 bits).
std::string text_id(const std::string &text);
} // namespace ligament::program
