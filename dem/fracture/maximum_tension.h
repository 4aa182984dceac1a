// The largest principal stress as the face carries it, theory.md eq. (D12).
#pragma once

#include "dem/fracture/criterion.h"
#include "dem/principal_tension.h"

namespace ligament::dem
{
template <int dim>
struct MaximumTension : PlainCriterion
{
  using Principal = PrincipalTension<dim>;

  static constexpr const char *name = "maximum_tension";
  static constexpr double tangent = Principal::tangent;
  static constexpr Clearing clearing = Clearing::by_stress;
  static constexpr bool needs_stress = true;
  static constexpr double apart = 1.6;

  /// Eq. (D12b).
  static double size_factor(double area_ratio)
  {
    return dim == 2 ? std::pow(std::max(area_ratio, 0.7), 0.3)
                    : std::pow(std::max(area_ratio, 0.5), 0.15);
  }
  static double tension(const LoadedFace<dim> &face)
  {
    const Vector<dim> e = Principal::direction(face.stress);
    const double cosine = face.normal.dot(e);
    return std::abs(cosine) < Principal::cone ? 0 : face.traction.dot(e) / cosine;
  }
  static double bound(const LoadedFace<dim> &face)
  {
    return Principal::bound(face.stress, face.normal, face.traction);
  }
};
} // namespace ligament::dem
