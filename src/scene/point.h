// Points of a scene: it is read before the dimension is known to the compiler.
#pragma once

#include <array>
#include <limits>
#include <optional>

namespace ligament::program
{
/// z is 0 in 2D.
using Point = std::array<double, 3>;
using PartialPoint = std::array<std::optional<double>, 3>;

inline constexpr double infinity = std::numeric_limits<double>::infinity();
} // namespace ligament::program
