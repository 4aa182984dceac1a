// What must be true of any scene, and whether it is of one that was drawn and computed.
#pragma once

#include "src/verification/cases/random_scenes_run.h"

#include <optional>
#include <string>
#include <vector>

namespace ligament::program
{
/// A figure of one scene; it holds when it does not exceed `must`. Definitions:
/// docs/verification_random.md.
struct SceneFigure
{
  std::string name;
  double value;
  double must; // infinite: stated only

  bool holds() const { return value <= must; } // a value that is not a number doesn't
};

/// What two models of a body may differ by before somebody looks closer.
constexpr double stiffness_bound = 3e-3, peak_bound = 1e-2;

/// Whether coupled and all discrete run differ by more, in scenes for which a bound stands.
bool stiffness_is_doubtful(const RandomScene &scene, const SceneRuns &runs);
bool peak_is_doubtful(const RandomScene &scene, const SceneRuns &runs);

/// All that applies to the scene. Of a scene that was refused: none.
std::vector<SceneFigure> judge(const RandomScene &scene, const SceneRuns &runs);

/// Why the coupled run says less than it could: "stopped", "breaks elsewhere", ...; empty: nothing.
std::string remark(const RandomScene &scene, const SceneRuns &runs);
} // namespace ligament::program
