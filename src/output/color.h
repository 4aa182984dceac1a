// A colour of the screen.
#pragma once

#include <cstdint>

namespace ligament::program
{
struct Color
{
  std::uint8_t r, g, b;
};
} // namespace ligament::program
