// The materials of a body: which particle is of which one, and what holds between two of them.
#pragma once

#include "dem/material.h"

#include <vector>

namespace ligament::dem
{
/// Material 0 is the one that the body shares with the far field.
class Materials
{
public:
  /// One material everywhere.
  Materials(const DemMaterial &material) : all_({material}) {}

  /// `of_particle` names the material of every particle; empty: all 0. Throws core::InputError when
  /// a constant lies outside its bounds, and where several materials differ in the plane mode or
  /// one of them has a negative Poisson's ratio.
  Materials(std::vector<DemMaterial> all, std::vector<int> of_particle)
      : all_(std::move(all)), of_particle_(std::move(of_particle))
  {
    core::require(!all_.empty(), "a body needs a material");
    for (const DemMaterial &m : all_) {
      m.check();
      core::require(all_.size() == 1 || (m.poissons_ratio >= 0 && m.plane == base().plane),
                    "bodies of several materials need Poisson's ratios of at least 0");
    }
    for (const int m : of_particle_)
      core::require(m >= 0 && m < int(all_.size()), "a particle's material does not exist");
  }

  const DemMaterial &base() const { return all_[0]; }
  const std::vector<DemMaterial> &all() const { return all_; }
  int number(int particle) const { return of_particle_.empty() ? 0 : of_particle_[particle]; }
  const DemMaterial &of(int particle) const { return all_[number(particle)]; }
  /// One more particle, of material number `of`.
  void append(int of)
  {
    if (!of_particle_.empty())
      of_particle_.push_back(of);
  }

  /// Whether the bond between the two particles joins different elastic constants.
  bool differ(int i, int j) const
  {
    const DemMaterial &a = of(i), &b = of(j);
    return a.youngs_modulus != b.youngs_modulus || a.poissons_ratio != b.poissons_ratio;
  }

  /// Whether all volumes have no stiffness of their own.
  bool has_no_dilatation() const
  {
    for (const DemMaterial &m : all_)
      if (m.poissons_ratio != 0)
        return false;
    return true;
  }

  /// Coulomb's coefficient between two particles: the smaller one.
  double friction(int i, int j) const { return std::min(of(i).friction, of(j).friction); }

private:
  std::vector<DemMaterial> all_;
  std::vector<int> of_particle_;
};

/// Stiffness in series of two parts of a bond that are `share` and 1 - share of its length.
inline double in_series(double stiffness_i, double stiffness_j, double share)
{
  return stiffness_i == stiffness_j ? stiffness_i
                                    : 1 / (share / stiffness_i + (1 - share) / stiffness_j);
}
} // namespace ligament::dem
