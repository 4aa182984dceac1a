#include "core/units.h"

#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <stdexcept>
#include <string>

using namespace ligament::core;

namespace
{
const double pi = std::acos(-1.0);

/// kg, m, s, rad
void expect_quantity(const std::string &text, double value, UnitExponents exponents)
{
  try {
    const Quantity q = parse_quantity(text);
    EXPECT_DOUBLE_EQ(q.value, value) << text;
    EXPECT_TRUE(same_dimension(q.exponents, exponents)) << text << " is " << to_string(q.exponents);
  } catch (const std::invalid_argument &error) {
    ADD_FAILURE() << text << ": " << error.what();
  }
}

std::string refusal(const std::string &text)
{
  try {
    parse_quantity(text);
  } catch (const std::invalid_argument &error) {
    return error.what();
  }
  return "";
}
} // namespace

TEST(Units, Quantities)
{
  const UnitExponents none = {0, 0, 0, 0}, length = {0, 1, 0, 0}, stress = {1, -1, -2, 0};
  expect_quantity("12.5 mm", 12.5 / 1000, length);
  expect_quantity("12.5mm", 12.5 / 1000, length);
  expect_quantity("  -3 um ", -3 / 1e6, length);
  expect_quantity("3 \u00b5m", 3 / 1e6, length); // micro sign
  expect_quantity("3 \u03bcm", 3 / 1e6, length); // Greek letter
  expect_quantity("2 nm", 2 / 1e9, length);
  expect_quantity("4 cm", 0.04, length);
  expect_quantity("1.5 dam", 15, length);
  expect_quantity("72 GPa", 72e9, stress);
  expect_quantity("1 bar", 1e5, stress);
  expect_quantity("3 N/mm^2", 3e6, stress);
  expect_quantity("3 kN/(mm^2)", 3e9, stress);
  expect_quantity("0.75 MPa*m^0.5", 0.75e6, {1, -0.5, -2, 0});
  expect_quantity("0.75 MPa m^(1/2)", 0.75e6, {1, -0.5, -2, 0});
  expect_quantity("0.75 MPa*sqrt(m)", 0.75e6, {1, -0.5, -2, 0});
  expect_quantity("2 N/mm^1.5", 2 * std::pow(10, 4.5), {1, -0.5, -2, 0});
  expect_quantity("22.2 kJ/m^2", 22.2e3, {1, 0, -2, 0});
  expect_quantity("3 J/m\u00b2", 3, {1, 0, -2, 0});
  expect_quantity("2450 kg/m^3", 2450, {1, -3, 0, 0});
  expect_quantity("2.45 g/cm^3", 2450, {1, -3, 0, 0});
  expect_quantity("2.45 g cm^-3", 2450, {1, -3, 0, 0});
  expect_quantity("2.45e-9 t/mm^3", 2450, {1, -3, 0, 0});
  expect_quantity("0.2 ms", 0.2 / 1000, {0, 0, 1, 0});
  expect_quantity("2 min", 120, {0, 0, 1, 0});
  expect_quantity("1.5 h", 5400, {0, 0, 1, 0});
  expect_quantity("10 mm/s", 0.01, {0, 1, -1, 0});
  expect_quantity("36 km/h", 10, {0, 1, -1, 0});
  expect_quantity("5 1/s", 5, {0, 0, -1, 0});
  expect_quantity("5 s^-1", 5, {0, 0, -1, 0});
  expect_quantity("5 kHz", 5e3, {0, 0, -1, 0});
  expect_quantity("15 deg", 15 * pi / 180, {0, 0, 0, 1});
  expect_quantity("15\u00b0", 15 * pi / 180, {0, 0, 0, 1});
  expect_quantity("20 mrad", 0.02, {0, 0, 0, 1});
  expect_quantity("40 %", 0.4, none);
  expect_quantity("0.3", 0.3, none);
  expect_quantity("3 m/m", 3, none);
  // / divides by the next factor only.
  expect_quantity("6 J/kg*s", 6, {0, 2, -1, 0});
  expect_quantity("6 J/(kg*s)", 6, {0, 2, -3, 0});
  expect_quantity("2 m^2/s^2", 2, {0, 2, -2, 0});
}

TEST(Units, NamesWithTwoReadings)
{
  expect_quantity("1 min", 60, {0, 0, 1, 0});    // not milli-inch
  expect_quantity("1 mN", 1e-3, {1, 1, -2, 0});  // not m N
  expect_quantity("1 m N", 1, {1, 2, -2, 0});    // a product
  expect_quantity("1 hPa", 100, {1, -1, -2, 0}); // not hour
  expect_quantity("1 Pa", 1, {1, -1, -2, 0});    // not peta-a
  expect_quantity("1 kg", 1, {1, 0, 0, 0});
}

// A decimal unit must not cost a rounding: the text and the plain SI number are the same double.
TEST(Units, DecimalUnitsAreExact)
{
  EXPECT_EQ(parse_quantity("12.5 mm").value, 0.0125);
  for (int k = 1; k < 100; ++k) // a multiplication by 0.001 misses 13 of them
    EXPECT_EQ(parse_quantity(std::to_string(k) + " mm").value, k / 1000.);
  EXPECT_EQ(parse_quantity("0.3 ms").value, 0.0003);
  EXPECT_EQ(parse_quantity("7 um").value, 7e-6);
  EXPECT_EQ(parse_quantity("2.45 g/cm^3").value, 2450);
  EXPECT_EQ(parse_quantity("72.1 GPa").value, 72.1e9);
}

TEST(Units, Refusals)
{
  EXPECT_NE(refusal("0.5 inch").find("no unit \"inch\""), std::string::npos);
  EXPECT_NE(refusal("mm").find("does not start with a finite number"), std::string::npos);
  EXPECT_NE(refusal("nan m").find("finite number"), std::string::npos);
  EXPECT_NE(refusal("-inf m").find("finite number"), std::string::npos);
  EXPECT_NE(refusal("1e400 m").find("too large"), std::string::npos);
  EXPECT_NE(refusal("1e300 Pm").find("too large"), std::string::npos);
  EXPECT_NE(refusal("0,5 mm").find("point"), std::string::npos);
  EXPECT_NE(refusal("1 N/(m").find("not closed"), std::string::npos);
  EXPECT_NE(refusal("1 m^").find("power"), std::string::npos);
  EXPECT_NE(refusal("1 m^99").find("power"), std::string::npos);
  EXPECT_NE(refusal("1 m)").find("unexpected"), std::string::npos);
  EXPECT_NE(refusal("1 m/").find("missing"), std::string::npos);
  EXPECT_NE(refusal("1 kt").find("no unit \"kt\""), std::string::npos); // t takes no prefix
  EXPECT_NE(refusal("").find("number"), std::string::npos);
  EXPECT_NE(refusal("1 2 m").find("no unit"), std::string::npos);
  EXPECT_NE(refusal("0x10 m").find("no unit"), std::string::npos);
}

TEST(Units, TextOfADimension)
{
  EXPECT_EQ(to_string(parse_unit("Pa").exponents), "kg/(m*s^2)");
  EXPECT_EQ(to_string(parse_unit("MPa*m^0.5").exponents), "kg/(m^0.5*s^2)");
  EXPECT_EQ(to_string(parse_unit("1/s").exponents), "1/s");
  EXPECT_EQ(to_string(parse_unit("m").exponents), "m");
  EXPECT_EQ(to_string(parse_unit("%").exponents), "1");
  EXPECT_EQ(to_string(parse_unit("J/K").exponents), "kg*m^2/(s^2*K)");
}

// Where no locale with a decimal comma is installed this repeats the case above.
TEST(Units, TheLocaleIsIgnored)
{
  std::setlocale(LC_ALL, "de_DE.UTF-8");
  const double value = parse_quantity("1.5 mm").value;
  std::setlocale(LC_ALL, "C");
  EXPECT_EQ(value, 0.0015);
}
