// Drucker and Prager's cone through two uniaxial strengths, theory.md eq. (D12g).
#pragma once

#include "dem/fracture/own_traction.h"

namespace ligament::dem
{
template <int dim>
struct DruckerPrager : TensorCriterion<dim>
{
  static constexpr const char *name = "drucker_prager";

  /// Exact under uniaxial tension and compression (in space, or in plane stress).
  static StressMeasure measure(const FaceStrength &strength, const DemMaterial &material)
  {
    const double ratio = strength.compressive, lateral = lateral_share<dim>(material);
    const double of_mises = (ratio + 1) / (2 * ratio);
    StressMeasure m;
    m.largest = 0;
    set_root<dim>(m, 1.5 * of_mises * of_mises, 0.5 * of_mises * of_mises, lateral);
    m.trace = (ratio - 1) / (2 * ratio) * (1 + lateral);
    return StressMeasure::with_own_traction(m);
  }
};
} // namespace ligament::dem
