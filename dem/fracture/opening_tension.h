// The largest principal stress as the face carries it, of faces that soften: theory.md section 1.13.
#pragma once

#include "dem/fracture/criterion.h"
#include "dem/principal_tension.h"

namespace ligament::dem
{
/// Maximum tension with a wider cone: an inclined face takes its share of the energy only, and one
/// that is left out would hold the crack.
template <int dim>
struct OpeningTension : PlainCriterion
{
  using Principal = PrincipalTension<dim>;
  static constexpr double cone = 0.3;

  static constexpr const char *name = "opening_tension";
  static constexpr double tangent = 3.18; // (1/cone^2 - 1)^(1/2)
  static constexpr Clearing clearing = Clearing::by_particle;
  static constexpr bool needs_stress = true;
  static constexpr double apart = 1.6;

  static double size_factor(double) { return 1; }
  static double tension(const LoadedFace<dim> &face)
  {
    const Vector<dim> e = Principal::direction(face.stress);
    const double cosine = face.normal.dot(e);
    return std::abs(cosine) < cone ? 0 : face.traction.dot(e) / cosine;
  }
  static double bound(const LoadedFace<dim> &face)
  {
    return Principal::bound(face.stress, face.normal, face.traction, cone);
  }
};
} // namespace ligament::dem
