// Eight numbers that fill one vector of the widest processors, several of the others.
#pragma once

namespace ligament::coupling
{
inline constexpr int octet_size = 8;

struct alignas(64) Octet
{
  double value[octet_size] = {};
};
} // namespace ligament::coupling
