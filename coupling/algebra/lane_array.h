// Eight numbers that fill one vector of the widest processors, several of the others.
#pragma once

namespace ligament::coupling
{
inline constexpr int lane_array_size = 8;

struct alignas(64) LaneArray
{
  double value[lane_array_size] = {};
};
} // namespace ligament::coupling
