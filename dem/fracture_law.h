// When a bond breaks: the criterion and its strengths.
#pragma once

#include "dem/fracture/drucker_prager.h"
#include "dem/fracture/face_tension.h"
#include "dem/fracture/maximum_tension.h"
#include "dem/fracture/mohr_coulomb.h"
#include "dem/fracture/opening_tension.h"
#include "dem/fracture/principal_stress.h"
#include "dem/fracture/rebonding.h"
#include "dem/fracture/strain_energy.h"
#include "dem/fracture/von_mises.h"
#include "dem/laws/cohesive.h"

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
    static constexpr CriterionRef opening_tension = dem::criterion<OpeningTension>();

    constexpr Criterion(CriterionRef criterion = none) : CriterionRef(criterion) {}
  };
  Criterion criterion = Criterion::none;
  FaceStrength strength = 0.;
  /// Of each material where a body has several; empty: `strength` for all. A bond between two
  /// breaks when it does so in one of them.
  std::vector<FaceStrength> strengths = {};
  /// m^2, thickness included: the whole face of size factors, eq. (D12b); 0: size doesn't matter.
  double whole_face = 0;
  /// Of each material; empty: that of all.
  std::vector<double> whole_faces = {};
  /// Of each material; empty: `criterion` for all. Bonds between two obey both.
  std::vector<Criterion> criteria = {};
  /// G_c in J per m^2 of projected crack, theory.md section 1.13, of each material where a body has
  /// several; with 0 a bond breaks at once. A bond between two softens as that one does whose
  /// criterion it reaches first.
  double energy = 0;
  std::vector<double> energies = {};
  Softening softening = {};
  double mode_ratio = 1; // beta: shear strength over tensile strength of a face that opens
  /// Of each material; empty: those of all.
  std::vector<Softening> softenings = {};
  std::vector<double> mode_ratios = {};
  /// Of each material; empty: what is broken stays so.
  std::vector<Rebonding> rebonding = {};

  /// Of cracks in each material, m/s, 0: any; empty: in all. Where it is limited faces that would
  /// break at once fall, theory.md section 1.15. A crack between two obeys both.
  std::vector<double> crack_velocities = {};

  bool falls() const
  {
    return std::any_of(crack_velocities.begin(), crack_velocities.end(),
                       [](double v) { return v > 0; });
  }
  double crack_velocity_of(int a, int b) const
  {
    if (crack_velocities.empty())
      return 0;
    const auto [slow, fast] = std::minmax(crack_velocities[a], crack_velocities[b]);
    return slow > 0 ? slow : fast;
  }
  /// Bonds break by the stresses of their two particles.
  bool reads_stresses() const
  {
    const auto reads = [](const Criterion &c) {
      return !(c == Criterion::none) && c.template in<2>().needs_stress;
    };
    return criteria.empty() ? reads(criterion)
                            : std::any_of(criteria.begin(), criteria.end(), reads);
  }

  /// Faces may stay bonds after they have reached their strength.
  bool faces_open() const { return softens() || falls(); }

  bool softens() const
  {
    return energy > 0 ||
           std::any_of(energies.begin(), energies.end(), [](double g) { return g > 0; });
  }
  /// Of the material of this number.
  double energy_of(int material) const { return energies.empty() ? energy : energies[material]; }
  Softening softening_of(int material) const
  {
    return softenings.empty() ? softening : softenings[material];
  }
  double mode_ratio_of(int material) const
  {
    return mode_ratios.empty() ? mode_ratio : mode_ratios[material];
  }
  /// Faces that soften begin under tension, whatever breaks others.
  bool can_soften() const
  {
    const auto opens = [](Criterion c) {
      return c == Criterion::opening_tension || c == Criterion::maximum_tension;
    };
    if (energies.empty() || criteria.empty())
      return opens(criterion);
    for (std::size_t m = 0; m < energies.size(); ++m)
      if (energies[m] > 0 && !opens(criteria[m]))
        return false;
    return true;
  }
};
} // namespace ligament::dem
