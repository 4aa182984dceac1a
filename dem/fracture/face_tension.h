// The normal stress on the face, theory.md section 1.6.
#pragma once

#include "dem/fracture/criterion.h"

namespace ligament::dem
{
template <int dim>
struct FaceTension : PlainCriterion
{
  static constexpr const char *name = "face_tension";
  static constexpr double tangent = 0;
  static constexpr Clearing clearing = Clearing::by_particle;
  static constexpr bool needs_stress = false;
  static constexpr double apart = 0;

  static double size_factor(double) { return 1; }
  static double tension(const LoadedFace<dim> &face) { return face.traction.dot(face.normal); }
  static double bound(const LoadedFace<dim> &face) { return tension(face); }
};
} // namespace ligament::dem
