// Quantities with units in text: "12.5 mm", "0.75 MPa*m^0.5", "22.2 kJ/m^2", "15 deg".
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace ligament::core
{
/// Exponents of kg, m, s, rad and K. Angles are kept apart so that a length is no angle.
using UnitExponents = std::array<double, 5>;

struct Quantity
{
  double value = 0; // in SI units
  UnitExponents exponents = {0, 0, 0, 0, 0};
};

/// A unit product: names with SI prefixes and powers, joined by * or a blank and / (which divides
/// by the next factor only, left to right), with brackets and sqrt(): "MPa*m^0.5", "J/(kg*s)",
/// "1/s". Returns its size in SI units as `value`; throws std::invalid_argument with the reason.
Quantity parse_unit(std::string_view text);

/// A finite number, followed by a unit unless it is dimensionless; "12.5 mm" is exactly the double
/// nearest to 0.0125. Throws std::invalid_argument with the reason.
Quantity parse_quantity(std::string_view text);

bool same_dimension(const UnitExponents &a, const UnitExponents &b);

/// "kg/(m*s^2)"; "1" without any.
std::string to_string(const UnitExponents &exponents);

/// Reads the whole token as a decimal number, whatever the locale. Numbers too small for a double
/// become 0; false when it is no number or too large for one.
bool read_number(std::string_view token, double &value);
} // namespace ligament::core
