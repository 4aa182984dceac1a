// The elastic energy that the stress at a face stores, theory.md eq. (D12g).
#pragma once

#include "dem/fracture/own_traction.h"

namespace ligament::dem
{
template <int dim>
struct StrainEnergy : TensorCriterion<dim>
{
  static constexpr const char *name = "energy";

  /// The root of 2 E times the energy per volume: the stress of a uniaxial tension that stores as
  /// much.
  static StressMeasure measure(const FaceStrength &, const DemMaterial &material)
  {
    const double nu = material.poissons_ratio;
    StressMeasure m;
    m.largest = 0;
    set_root<dim>(m, 1 + nu, nu, lateral_share<dim>(material));
    return StressMeasure::with_own_traction(m);
  }
  /// What is pressed together stores energy, too, but opening it frees none.
  static double tension(const LoadedFace<dim> &face)
  {
    return face.traction.dot(face.normal) > 0 ? OwnTraction<dim>::tension(face) : 0;
  }
  static double bound(const LoadedFace<dim> &face) { return tension(face); }
};
} // namespace ligament::dem
