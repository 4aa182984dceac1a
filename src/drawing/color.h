// A colour of the screen.
#pragma once

#include <array>
#include <cstdint>

namespace ligament::program
{
struct Color
{
  std::uint8_t r, g, b;
};

/// Colours of a value t in [0, 1].
using Palette = std::array<Color, 256>;

inline constexpr Color ink = {40, 40, 40};
inline constexpr Color white = {255, 255, 255};
} // namespace ligament::program
