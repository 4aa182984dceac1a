// What must be true of any scene, and whether it is of one that was drawn and computed.
#pragma once

#include "src/verification/random_scenes_run.h"

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

/// All that applies to the scene. Of a scene that was refused: none.
std::vector<SceneFigure> judge(const RandomScene &scene, const SceneRuns &runs);

/// Why the coupled run says less than it could: "stopped", "breaks elsewhere", ...; empty: nothing.
std::string remark(const RandomScene &scene, const SceneRuns &runs);
} // namespace ligament::program
