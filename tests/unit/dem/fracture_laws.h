// The criteria of whole tensors with strengths of their own, for the program and for its oracle.
#pragma once

#include "dem/fracture_law.h"
#include "tests/oracle/fracture_oracle.h"

namespace ligament::dem::testing
{
/// Strengths as shares of one number, so that a law can be set to any of them.
struct TensorLaw
{
  FractureLaw::Criterion criterion;
  FaceStrength strength;
  oracle::Strengths plain; // at `strength` of 1 Pa

  FractureLaw at(double tension) const
  {
    FractureLaw law{criterion, strength};
    law.strength.value = tension;
    return law;
  }
  oracle::Strengths plain_of(const DemMaterial &material) const
  {
    oracle::Strengths of = plain;
    of.poissons_ratio = material.poissons_ratio;
    of.plane_strain = material.plane == PlaneMode::strain;
    return of;
  }
};

inline std::vector<TensorLaw> tensor_laws()
{
  using Criterion = FractureLaw::Criterion;
  FaceStrength rock = 1., soil = 1.;
  rock.compressive = 8;
  // A cut-off at three quarters of what the slope alone bears in tension.
  soil.friction_angle = 0.6;
  soil.cohesion = (1 + std::sin(0.6)) / (2 * std::cos(0.6)) / 0.75;
  return {{Criterion::principal_stress, 1., {"principal_stress"}},
          {Criterion::von_mises, 1., {"von_mises"}},
          {Criterion::drucker_prager, rock, {"drucker_prager", 1, 8}},
          {Criterion::mohr_coulomb, soil, {"mohr_coulomb", 1, 0, soil.cohesion, 0.6}},
          {Criterion::energy, 1., {"energy"}}};
}
} // namespace ligament::dem::testing
