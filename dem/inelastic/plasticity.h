// Laws of plastic flow: what a material is told of them, in plain numbers.
#pragma once

#include "core/check.h"
#include "core/types.h"

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

namespace ligament::dem
{
/// Yield stress in Pa over the accumulated plastic strain p: Y + H p + Q (1 - exp(-b p)), or a
/// table.
struct YieldCurve
{
  double initial = 0;    // Y, Pa
  double hardening = 0;  // H, Pa
  double saturation = 0; // Q, Pa (Voce)
  double rate = 0;       // b, -
  /// Straight between its points and level behind the last; empty: the formula.
  std::vector<double> strain = {}, stress = {}; // -, Pa

  double at(double p) const
  {
    if (strain.empty())
      return initial + hardening * p + saturation * (1 - std::exp(-rate * p));
    std::size_t k = 1;
    while (k < strain.size() && strain[k] < p)
      ++k;
    if (k == strain.size())
      return stress.back();
    return stress[k - 1] +
           (stress[k] - stress[k - 1]) * (p - strain[k - 1]) / (strain[k] - strain[k - 1]);
  }

  /// Energy in J/m^3 that hardening stores up to p: the part of the plastic work above the first
  /// yield stress.
  double stored(double p) const
  {
    if (strain.empty())
      return 0.5 * hardening * p * p +
             (rate > 0 ? saturation * (p - (1 - std::exp(-rate * p)) / rate) : 0);
    double sum = 0;
    for (std::size_t k = 0; k < strain.size() && strain[k] < p; ++k) {
      const double end = k + 1 < strain.size() ? std::min(p, strain[k + 1]) : p;
      sum += (end - strain[k]) * (0.5 * (stress[k] + at(end)) - stress[0]);
    }
    return sum;
  }

  /// Throws core::InputError unless the yield stress is positive and never falls.
  void check() const
  {
    core::require(strain.size() == stress.size(), "a yield curve has as many strains as stresses");
    if (!strain.empty())
      core::require(strain[0] == 0, "a yield curve begins at the plastic strain 0");
    for (std::size_t k = 1; k < strain.size(); ++k)
      core::require(strain[k] > strain[k - 1] && stress[k] >= stress[k - 1],
                    "strains of a yield curve rise, and stresses don't fall");
    core::require(at(0) > 0, "the yield stress must be positive");
    core::require(hardening >= 0 && saturation >= 0 && rate >= 0, "the yield stress must not fall");
  }
};

/// Flow at the equivalent stress sqrt(3/2 s:s) = Y(p), along the deviator s.
struct VonMisesFlow
{
  YieldCurve yield;
};

/// Flow at friction sigma_m + sqrt(1/2 s:s) = Y, with volume strain (Nikolaevskiy): theory.md
/// eq. (D25).
struct DruckerPragerFlow
{
  double cohesion = 0;  // Y, Pa
  double hardening = 0; // of Y over the accumulated plastic shear strain, Pa; below 0: Y falls to 0
  double friction = 0;  // b, -
  double dilatancy = 0; // Lambda, -

  double yield_at(double history) const { return std::max(cohesion + hardening * history, 0.); }
};

/// std::monostate: elastic.
using Plasticity = std::variant<std::monostate, VonMisesFlow, DruckerPragerFlow>;

inline bool flows(const Plasticity &law)
{
  return law.index() != 0;
}

/// Share of the stress under which a material without history flows: of a tensor in Voigt order
/// (in-plane components in 2D) with the given stress out of the plane, in Pa.
template <int dim>
double flow_share(const Plasticity &law, const Strain<dim> &stress, double out_of_plane)
{
  const double zz = dim == 2 ? out_of_plane : stress[2];
  const double mean = (stress[0] + stress[1] + zz) / 3;
  double square = std::pow(stress[0] - mean, 2) + std::pow(stress[1] - mean, 2) +
                  std::pow(zz - mean, 2);
  for (int c = dim == 2 ? 2 : 3; c < n_strains<dim>; ++c)
    square += 2 * stress[c] * stress[c];
  if (const auto *mises = std::get_if<VonMisesFlow>(&law))
    return std::sqrt(1.5 * square) / mises->yield.at(0);
  if (const auto *prager = std::get_if<DruckerPragerFlow>(&law))
    return (prager->friction * mean + std::sqrt(0.5 * square)) / prager->cohesion;
  return 0;
}

/// Energy in J/m^3 that hardening has stored at this history.
inline double stored_energy(const Plasticity &law, double history)
{
  if (const auto *mises = std::get_if<VonMisesFlow>(&law))
    return mises->yield.stored(history);
  if (const auto *prager = std::get_if<DruckerPragerFlow>(&law))
    return 0.5 * std::max(prager->hardening, 0.) * history * history;
  return 0;
}

/// Throws core::InputError when a number lies outside its bounds.
inline void check(const Plasticity &law)
{
  if (const auto *mises = std::get_if<VonMisesFlow>(&law))
    mises->yield.check();
  if (const auto *prager = std::get_if<DruckerPragerFlow>(&law)) {
    core::require(prager->cohesion > 0, "the cohesion must be positive");
    core::require(prager->dilatancy >= 0 && prager->dilatancy <= prager->friction,
                  "the dilatancy must lie between 0 and the friction");
  }
}
} // namespace ligament::dem
