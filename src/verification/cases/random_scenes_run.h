// Drawn scenes computed: coupled, all discrete, in a mirror and with half the step.
#pragma once

#include "src/output/fields.h"
#include "src/output/run_record.h"
#include "src/output/table.h"
#include "src/verification/cases/random_scenes_draw.h"

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

/// Runs that tell what coupling does from what either model does alone; empty where nobody asked.
struct CloserLook
{
  /// The body without crack or hole, as a mesh and as particles.
  std::optional<SceneRun> mesh, particles;
  /// Peak loads in N with steps of 1, 0.95, 0.9, 0.8 and 0.5 of the scene's.
  std::vector<double> coupled_peaks, discrete_peaks;
};

struct SceneRuns
{
  std::string refused; // why the coupled scene can't be run; empty: it ran
  SceneRun coupled, discrete, mirror, half_step;
  double overlap = 0;      // m, width
  double far_step = 0;     // s, of the coupled run
  bool has_mirror = true;  // there is one to compute
  bool is_mirrored = true; // the mirror's scene could be built
  CloserLook closer;
  double seconds = 0; // of the processor, without the closer look
};

/// Runs of all variants in subfolders of `folder`, which the caller removes. Those in a mirror and
/// with half the step end soon after the first face of the coupled one breaks.
SceneRuns run_scene(const RandomScene &scene, const std::string &folder);

/// Adds the closer look at the stiffness, at the peak, or both.
void look_closer(const RandomScene &scene, const std::string &folder, bool at_stiffness,
                 bool at_peak, SceneRuns &runs);

/// The scene's files for `ligament run`: scene.json, all_discrete.json, half_step.json and
/// mirror.json (of lattices; that of an irregular packing needs the particles of a run).
void write_scene(const RandomScene &scene, const std::string &folder);
} // namespace ligament::program
