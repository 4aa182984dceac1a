// What a face bears: the numbers that criteria of fracture compare with, and their scatter.
#pragma once

#include "core/counter_random.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace ligament::dem
{
/// Weibull's distribution of strengths with mean 1 at the reference area, theory.md eq. (D12i). A
/// face's own factor follows from the names of its particles and the seed alone.
struct WeibullScatter
{
  double modulus = 0;        // 0: every face bears the same
  double reference_area = 0; // m^2, of the face of the given mean; 0: of every face
  std::int64_t seed = 1;

  double factor(std::int64_t name_i, std::int64_t name_j, double area) const
  {
    if (modulus <= 0)
      return 1;
    const auto [first, second] = std::minmax(name_i, name_j);
    // A stream of its own for each first name and seed, and in it one for each second name.
    const std::int64_t stream = std::int64_t(core::mix(std::uint64_t(first) + core::mix(seed)));
    const double open = std::max(core::random_number(stream, second, 0), 0x1p-54);
    const double size = reference_area > 0 ? reference_area / area : 1;
    return std::pow(-size * std::log(open), 1 / modulus) / std::tgamma(1 + 1 / modulus);
  }
};

/// Of the faces of one material.
struct FaceStrength
{
  FaceStrength(double tension = 0) : value(tension) {}

  double value; // Pa, at which a uniaxial tension breaks it
  // Of criteria that need it; over `value`, so that all scale with it.
  double compressive = 1;    // uniaxial compressive strength
  double cohesion = 0;       // shear strength of a plane without normal stress
  double cut_off = 1;        // largest principal stress
  double friction_angle = 0; // rad
  WeibullScatter scatter = {};
};
} // namespace ligament::dem
