// Von Mises's equivalent stress, theory.md eq. (D12g).
#pragma once

#include "dem/fracture/own_traction.h"

namespace ligament::dem
{
template <int dim>
struct VonMises : TensorCriterion<dim>
{
  static constexpr const char *name = "von_mises";

  static StressMeasure measure(const FaceStrength &, const DemMaterial &material)
  {
    StressMeasure m;
    m.largest = 0;
    set_root<dim>(m, 1.5, 0.5, lateral_share<dim>(material));
    return StressMeasure::with_own_traction(m);
  }
};
} // namespace ligament::dem
