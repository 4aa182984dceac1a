// Random numbers without a state: each follows from a seed, a name and a counter alone.
#pragma once

#include <cstdint>
#include <string_view>

namespace ligament::core
{
/// A bijection of 64 bits without visible pattern (the finaliser of SplitMix64; G. Steele, D. Lea,
/// C. Flood 2014).
constexpr std::uint64_t mix(std::uint64_t x)
{
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ x >> 27) * 0x94d049bb133111ebull;
  return x ^ x >> 31;
}

/// Number `counter` of the stream of random numbers in [0, 1) that belongs to this seed and name;
/// the same on every machine.
constexpr double random_number(std::int64_t seed, std::int64_t name, int counter)
{
  constexpr std::uint64_t step = 0x9e3779b97f4a7c15ull;
  const std::uint64_t key = mix(mix(step + std::uint64_t(seed)) + std::uint64_t(name) * step);
  return double(mix(key + std::uint64_t(counter + 1) * step) >> 11) * 0x1p-53;
}

/// The name of a stream that has a word for it (FNV-1a; G. Fowler, L. Noll, K.-P. Vo).
constexpr std::int64_t stream_name(std::string_view word)
{
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const char c : word)
    hash = (hash ^ std::uint8_t(c)) * 0x100000001b3ull;
  return std::int64_t(hash);
}
} // namespace ligament::core
