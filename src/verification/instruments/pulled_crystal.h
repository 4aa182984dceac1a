// A crystal with a crack, drawn apart until bonds part: coupled or of atoms alone.
#pragma once

#include "src/scene/scene.h"

#include <string>
#include <vector>

namespace ligament::program
{
struct PulledCrystal
{
  Scene scene;
  int n_atoms = 0;
  /// As the first bond between nearest neighbours parts, which is looked for when the list of
  /// neighbours is built anew: mean strain by the motion of the ends, and load in N, from a
  /// straight line through the last 5 ps. Not a number if none parts.
  double strain, load;
  std::vector<Vector<3>> places; // m, of the parted bonds in the order in which they part
  double processor_time = 0;     // s, of the steps until the first one parts
};

/// Scenes of atoms in 3D whose loads, that of the top first, draw top and bottom apart alike. The
/// run ends when so many bonds have parted, or with the scene. Throws core::InputError for a scene
/// with errors.
PulledCrystal pull_crystal(const char *scene, const std::vector<std::string> &set, int n_parted);
} // namespace ligament::program
