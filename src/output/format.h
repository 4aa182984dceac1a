// Numbers as people read them, the same in log, table, report and plot.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace ligament::program
{
/// 121000 -> "121 000".
std::string grouped(std::int64_t n);

/// Three significant digits with the SI prefix that fits: (2.5e6, "Pa") -> "2.50 MPa". Units with
/// a power (m^2) or none get a power of ten instead.
std::string quantity(double value, const std::string &unit);

/// "(12.0 mm, -3.00 mm)", of coordinates in m.
template <typename Coordinates>
std::string place(const Coordinates &x)
{
  std::string text;
  for (int c = 0; c < int(x.size()); ++c)
    text += (c ? ", " : "") + quantity(x[c], "m");
  return "(" + text + ")";
}

/// "+0.31 %"; "-" when empty.
std::string percent(const std::optional<double> &fraction);

/// "12.3 s", "3 min 20 s", "2 h 05 min".
std::string duration(double seconds);

/// A power of ten and its prefix for numbers of this magnitude: 1e6 -> {1e6, "M"}.
struct Prefix
{
  double factor;
  std::string symbol;
};
Prefix si_prefix(double magnitude);

/// The same where the unit can carry one; none for plain numbers, powers and products.
Prefix unit_prefix(double magnitude, const std::string &unit);
/// "stress (MPa)"; plain numbers have no brackets.
std::string with_unit(const std::string &name, const Prefix &prefix, const std::string &unit);

/// Text for HTML and XML: & < > " escaped.
std::string escape_xml(const std::string &text);

/// Base64 of any bytes.
std::string base64(const void *data, std::size_t n_bytes);
/// Its inverse; reads up to the first character that is no digit.
std::string from_base64(std::string_view text);
} // namespace ligament::program
