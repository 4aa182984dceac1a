// Stability under stress: the settings that are tried, and which cases belong to it.
#pragma once

#include "src/scene/scene.h"
#include "src/verification/cases.h"

namespace ligament::program
{
/// A band of particles across a bar, undamped or with the dampers for fracture (c_f 8, c_g 4).
struct StabilitySetting
{
  std::string packing;
  int dimension;
  double poissons_ratio, step_fraction;
  coupling::Scheme scheme;
  int step_ratio;
  double cell_size; // h/d
  int overlap_cells;
  bool damped;

  std::string name() const;
  /// A bar of this width in d, in 3D square.
  Scene scene(double width) const;
};

/// The same scene held at both ends of its bar: no rigid motion.
Scene held(Scene scene);

/// Eigenvalues of the step operator of small bodies.
std::vector<Case> spectrum_cases();

/// Shapes and loads at the edge of what the set-up accepts.
std::vector<Case> stress_cases();

/// `verify --stability`: the covering set, the stress cases and the free spinning bodies; with
/// `full` also the long runs.
std::vector<Case> select_stability(bool full);
} // namespace ligament::program
