// Coulomb's plane of slip with a cut-off in tension, theory.md eq. (D12h).
#pragma once

#include "dem/fracture/own_traction.h"

namespace ligament::dem
{
template <int dim>
struct MohrCoulomb : TensorCriterion<dim>
{
  static constexpr const char *name = "mohr_coulomb";

  /// Of all planes (2D: those across the plane) the one with the largest |tau| + sigma tan(phi).
  static StressMeasure measure(const FaceStrength &strength, const DemMaterial &)
  {
    const double sine = std::sin(strength.friction_angle),
                 twice_cosine = 2 * std::cos(strength.friction_angle);
    StressMeasure m;
    m.largest = (1 + sine) / twice_cosine / strength.cohesion;
    m.opposite = (1 - sine) / twice_cosine / strength.cohesion;
    m.cut = 1 / strength.cut_off;
    return StressMeasure::with_own_traction(m);
  }
};
} // namespace ligament::dem
