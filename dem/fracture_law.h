// When a bond breaks: the criterion and its strengths.
#pragma once

#include "dem/fracture/drucker_prager.h"
#include "dem/fracture/face_tension.h"
#include "dem/fracture/maximum_tension.h"
#include "dem/fracture/mohr_coulomb.h"
#include "dem/fracture/principal_stress.h"
#include "dem/fracture/strain_energy.h"
#include "dem/fracture/von_mises.h"

#include <vector>

namespace ligament::dem
{
/// theory.md section 1.6.
struct FractureLaw
{
  /// One of dem/fracture, or any other that criterion() makes of a struct.
  struct Criterion : CriterionRef
  {
    static constexpr CriterionRef none{};
    static constexpr CriterionRef face_tension = dem::criterion<FaceTension>();
    static constexpr CriterionRef maximum_tension = dem::criterion<MaximumTension>();
    static constexpr CriterionRef principal_stress = dem::criterion<PrincipalStress>();
    static constexpr CriterionRef von_mises = dem::criterion<VonMises>();
    static constexpr CriterionRef drucker_prager = dem::criterion<DruckerPrager>();
    static constexpr CriterionRef mohr_coulomb = dem::criterion<MohrCoulomb>();
    static constexpr CriterionRef energy = dem::criterion<StrainEnergy>();

    constexpr Criterion(CriterionRef criterion = none) : CriterionRef(criterion) {}
  };
  Criterion criterion = Criterion::none;
  FaceStrength strength = 0.;
  /// Of each material where a body has several; empty: `strength` for all. A bond between two
  /// breaks when it does so in one of them.
  std::vector<FaceStrength> strengths = {};
  /// m^2, thickness included: the whole face of size factors, eq. (D12b); 0: size doesn't matter.
  double whole_face = 0;
  /// Of each material; empty: `criterion` for all. Bonds between two obey both.
  std::vector<Criterion> criteria = {};
};
} // namespace ligament::dem
