// When a bond breaks: the criterion and its strengths.
#pragma once

#include "dem/fracture/face_tension.h"
#include "dem/fracture/maximum_tension.h"
#include "dem/fracture/opening_tension.h"
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
    static constexpr CriterionRef opening_tension = dem::criterion<OpeningTension>();

    constexpr Criterion(CriterionRef criterion = none) : CriterionRef(criterion) {}
  };
  Criterion criterion = Criterion::none;
  double strength = 0; // Pa
  /// Pa, of each material where a body has several; empty: `strength` for all. A bond between two
  /// breaks at the smaller one.
  std::vector<double> strengths = {};
  /// m^2, thickness included: the whole face of size factors, eq. (D12b); 0: size doesn't matter.
  double whole_face = 0;
  /// G_c in J per m^2 of projected crack, theory.md section 1.13, of each material where a body has
  /// several; with 0 a bond breaks at once. A bond between two takes the smaller one.
  double energy = 0;
  std::vector<double> energies = {};
  Softening softening = {};
  double mode_ratio = 1; // beta: shear strength over tensile strength of a face that opens

  bool softens() const
  {
    return energy > 0 ||
           std::any_of(energies.begin(), energies.end(), [](double g) { return g > 0; });
  }
};
} // namespace ligament::dem
