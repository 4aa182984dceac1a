// Near-normal random numbers without a state: what a thermostat kicks particles with.
#pragma once

#include "core/counter_random.h"

namespace ligament::core
{
/// Numbers of one seed and step. Each follows from particle, component and stream alone, whoever
/// asks and in whatever order.
class ThermalNoise
{
public:
  constexpr ThermalNoise(std::int64_t seed, std::int64_t step)
      : key_(mix(mix(golden + std::uint64_t(seed)) + std::uint64_t(step) * golden))
  {
  }

  /// Mean 0 and variance 1 exactly, odd moments 0, kurtosis 2.7 (a normal number's is 3), within
  /// +-3.47: the sum of the four 16-bit parts of one hash. component < 4, stream < 8.
  constexpr double operator()(std::int64_t particle, int component, int stream) const
  {
    const std::uint64_t counter =
        std::uint64_t(particle) * 32 + std::uint64_t(stream * 4 + component) + 1;
    const std::uint64_t hash = mix(key_ + counter * golden);
    const std::uint64_t sum =
        (hash & 0xffff) + (hash >> 16 & 0xffff) + (hash >> 32 & 0xffff) + (hash >> 48);
    return (double(sum) - 2 * 65535.) * scale;
  }

  // The variance of four parts is 4 (2^32 - 1)/12.
  static constexpr double scale = 2.6428997921303018e-05; // sqrt(3/(2^32 - 1))

private:
  static constexpr std::uint64_t golden = 0x9e3779b97f4a7c15ull;
  std::uint64_t key_;
};
} // namespace ligament::core
