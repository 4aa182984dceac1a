// The largest principal stress of the tensor with the face's own traction, theory.md eq. (D12e).
#pragma once

#include "dem/fracture/own_traction.h"

namespace ligament::dem
{
template <int dim>
struct PrincipalStress : TensorCriterion<dim>
{
  using Principal = PrincipalTension<dim>;

  static constexpr const char *name = "principal_stress";
  // A face that opens: with t . e1 = s1 n . e1 the bound (D12c) holds as for maximum tension.
  static constexpr double tangent = Principal::tangent;
  static constexpr double least_share = 1;

  static StressMeasure measure(const FaceStrength &, const DemMaterial &)
  {
    return StressMeasure::with_own_traction({});
  }
  static double tension(const LoadedFace<dim> &face)
  {
    const Strain<dim> stress = OwnTraction<dim>::stress_of(face);
    const double cosine = face.normal.dot(Principal::direction(stress));
    return std::abs(cosine) < Principal::cone ? 0 : PrincipalRange<dim>(stress).largest;
  }
  static double bound(const LoadedFace<dim> &face)
  {
    return PrincipalRange<dim>(OwnTraction<dim>::stress_of(face)).largest;
  }
};
} // namespace ligament::dem
