#include "src/output/format.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ligament::program
{
namespace
{
/// From 1 atto to 1000 tera.
bool bears_prefix(double value)
{
  return std::abs(value) >= 1e-18 && std::abs(value) < 1e15;
}
} // namespace

std::string grouped(std::int64_t n)
{
  const std::string digits = std::to_string(n < 0 ? -n : n);
  std::string text = n < 0 ? "-" : "";
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0)
      text += ' ';
    text += digits[i];
  }
  return text;
}

Prefix si_prefix(double magnitude)
{
  static constexpr std::array<const char *, 11> symbols = {"a", "f", "p", "n", "µ", "m",
                                                           "",  "k", "M", "G", "T"};
  if (!(magnitude > 0) || !std::isfinite(magnitude))
    return {1, ""};
  // The small slack keeps 999.9999999 k from appearing as 1000 k.
  const int power = std::clamp(int(std::floor((std::log10(magnitude) + 1e-9) / 3)), -6, 4);
  return {std::pow(1000., power), symbols[power + 6]};
}

std::string quantity(double value, const std::string &unit)
{
  if (!std::isfinite(value))
    return "-";
  if (unit == "kg" && bears_prefix(1000 * value)) // a unit has one prefix
    return quantity(1000 * value, "g");
  const bool plain = unit.empty() || unit == "1";
  if (plain || (value != 0 && (unit == "kg" || !bears_prefix(value))) ||
      unit.find_first_of("^*/ ") != std::string::npos)
    return fmt::format("{:.3g}{}{}", value, plain ? "" : " ", plain ? "" : unit);
  const Prefix prefix = si_prefix(std::abs(value));
  const double scaled = value / prefix.factor;
  const int before = std::abs(scaled) >= 100 ? 3 : std::abs(scaled) >= 10 ? 2 : 1;
  return fmt::format("{:.{}f} {}{}", scaled, value == 0 ? 0 : 3 - before, prefix.symbol, unit);
}

Prefix unit_prefix(double magnitude, const std::string &unit)
{
  const bool plain =
      unit.empty() || unit == "1" || unit == "kg" || unit.find_first_of("^* ") != std::string::npos;
  return plain ? Prefix{1, ""} : si_prefix(magnitude);
}

std::string with_unit(const std::string &name, const Prefix &prefix, const std::string &unit)
{
  if (unit.empty() || unit == "1")
    return name;
  return fmt::format("{} ({}{})", name, prefix.symbol, unit);
}

std::string percent(const std::optional<double> &fraction)
{
  return fraction ? fmt::format("{:+.2f} %", 100 * *fraction) : "-";
}

std::string duration(double seconds)
{
  if (!(seconds >= 0) || !std::isfinite(seconds))
    return "-";
  if (seconds < 10)
    return fmt::format("{:.2g} s", seconds);
  if (seconds < 99.5)
    return fmt::format("{:.0f} s", seconds);
  const auto whole = std::int64_t(std::llround(seconds));
  if (whole < 3600)
    return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

std::string escape_xml(const std::string &text)
{
  std::string escaped;
  for (const char c : text)
    switch (c) {
    case '&':
      escaped += "&amp;";
      break;
    case '<':
      escaped += "&lt;";
      break;
    case '>':
      escaped += "&gt;";
      break;
    case '"':
      escaped += "&quot;";
      break;
    default:
      escaped += c;
    }
  return escaped;
}

std::string base64(const void *data, std::size_t n_bytes)
{
  static constexpr char digits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto *bytes = static_cast<const unsigned char *>(data);
  std::string text;
  text.reserve((n_bytes + 2) / 3 * 4);
  for (std::size_t i = 0; i < n_bytes; i += 3) {
    const std::size_t n = std::min<std::size_t>(3, n_bytes - i);
    unsigned group = bytes[i] << 16;
    group |= n > 1 ? bytes[i + 1] << 8 : 0;
    group |= n > 2 ? bytes[i + 2] : 0;
    for (std::size_t k = 0; k < 4; ++k)
      text += k <= n ? digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string from_base64(std::string_view text)
{
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  unsigned group = 0;
  int bits = 0;
  for (const char c : text) {
    int digit;
    if (c >= 'A' && c <= 'Z')
      digit = c - 'A';
    else if (c >= 'a' && c <= 'z')
      digit = c - 'a' + 26;
    else if (c >= '0' && c <= '9')
      digit = c - '0' + 52;
    else if (c == '+' || c == '/')
      digit = c == '+' ? 62 : 63;
    else
      break;
    group = (group << 6 | unsigned(digit)) & 0xffffff;
    bits += 6;
    if (bits >= 8) {
      bits -= 8;
      bytes += char(group >> bits & 0xff);
    }
  }
  return bytes;
}
} // namespace ligament::program
