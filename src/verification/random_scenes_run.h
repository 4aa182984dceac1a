// Drawn scenes computed: coupled, all discrete, in a mirror and with half the step.
#pragma once

#include "src/output/fields.h"
#include "src/output/run_record.h"
#include "src/output/table.h"
#include "src/verification/random_scenes_draw.h"

#include <optional>
#include <string>
#include <vector>

namespace ligament::program
{
/// What one run left in its folder.
struct SceneRun
{
  RunRecord record;
  Table history;
  std::vector<BrokenBond> broken; // in the order of time
  long n_warnings = 0;            // about the result

  /// s; empty when nothing broke.
  std::optional<double> onset() const;
};

struct SceneRuns
{
  std::string refused; // why the coupled scene can't be run; empty: it ran
  SceneRun coupled, discrete, mirror, half_step;
  double overlap = 0;      // m, width
  double far_step = 0;     // s, of the coupled run
  bool has_mirror = true;  // there is one to compute
  bool is_mirrored = true; // the mirror's scene could be built
  double seconds = 0;      // of the processor
};

/// Runs of all variants in subfolders of `folder`, which the caller removes. Those in a mirror and
/// with half the step end soon after the first face of the coupled one breaks.
SceneRuns run_scene(const RandomScene &scene, const std::string &folder);

/// The scene's files for `ligament run`: scene.json, all_discrete.json, half_step.json and
/// mirror.json (of lattices; that of an irregular packing needs the particles of a run).
void write_scene(const RandomScene &scene, const std::string &folder);
} // namespace ligament::program
