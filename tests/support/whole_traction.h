// A toy fracture criterion: the whole traction of a face under tension, in any direction.
#pragma once

#include "dem/fracture/criterion.h"

namespace ligament::tests
{
/// sqrt(sigma^2 + tau^2) is at most sigma + |tau|; faces may bear more than any principal stress.
template <int dim>
struct WholeTraction : dem::PlainCriterion
{
  static constexpr const char *name = "whole_traction";
  static constexpr double tangent = 1;
  static constexpr auto clearing = dem::Clearing::by_face;
  static constexpr bool needs_stress = false;
  static constexpr double apart = 0;

  static double size_factor(double) { return 1; }
  static double tension(const dem::LoadedFace<dim> &face) { return face.traction.norm(); }
  static double bound(const dem::LoadedFace<dim> &face) { return tension(face); }
};
} // namespace ligament::tests
