// Viscosity of a material: what it is told of its relaxation and damping, in plain numbers.
#pragma once

#include "core/check.h"

#include <vector>

namespace ligament::dem
{
/// A spring and a dashpot in series beside the long-time spring.
struct RelaxingBranch
{
  double share = 0; // of the shear modulus, which is the instantaneous one
  double time = 0;  // s, of relaxation
};

/// Of the deviator alone: the generalised Maxwell material, and Kelvin and Voigt's dashpot beside
/// it. Neither: elastic.
struct Viscosity
{
  std::vector<RelaxingBranch> branches = {};
  double dashpot = 0; // shear viscosity, Pa s

  double relaxing_share() const
  {
    double sum = 0;
    for (const RelaxingBranch &b : branches)
      sum += b.share;
    return sum;
  }

  /// Throws core::InputError when a number lies outside its bounds.
  void check() const
  {
    for (const RelaxingBranch &b : branches)
      core::require(b.share > 0 && b.time > 0,
                    "share and relaxation time of a branch must be positive");
    constexpr double round_off = 1e-9;
    core::require(relaxing_share() <= 1 + round_off,
                  "the branches have more than the whole shear modulus");
    core::require(dashpot >= 0, "the viscosity must not be negative");
  }
};

inline bool is_viscous(const Viscosity &v)
{
  return !v.branches.empty() || v.dashpot > 0;
}
} // namespace ligament::dem
