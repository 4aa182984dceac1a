#include "core/units.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <system_error>

namespace ligament::core
{
namespace
{
/// A unit is number * 10^decimals in SI. Powers of ten are kept apart and applied to the value at
/// the end, by one multiplication or division, so that decimal units do not cost a rounding.
struct Unit
{
  double number = 1;
  double decimals = 0;
  UnitExponents exponents = {0, 0, 0, 0, 0};
};

struct NamedUnit
{
  std::string_view name;
  Unit unit;
  bool takes_prefix;
};

constexpr double pi = 3.14159265358979323846;

constexpr NamedUnit named_units[] = {
    {"m", {1, 0, {0, 1, 0, 0, 0}}, true},
    {"g", {1, -3, {1, 0, 0, 0, 0}}, true},
    {"t", {1, 3, {1, 0, 0, 0, 0}}, false},
    {"s", {1, 0, {0, 0, 1, 0, 0}}, true},
    {"min", {60, 0, {0, 0, 1, 0, 0}}, false},
    {"h", {3600, 0, {0, 0, 1, 0, 0}}, false},
    {"Hz", {1, 0, {0, 0, -1, 0, 0}}, true},
    {"N", {1, 0, {1, 1, -2, 0, 0}}, true},
    {"Pa", {1, 0, {1, -1, -2, 0, 0}}, true},
    {"bar", {1, 5, {1, -1, -2, 0, 0}}, true},
    {"J", {1, 0, {1, 2, -2, 0, 0}}, true},
    {"eV", {1.602176634, -19, {1, 2, -2, 0, 0}}, true},
    {"u", {1.66053906660, -27, {1, 0, 0, 0, 0}}, false},
    {"angstrom", {1, -10, {0, 1, 0, 0, 0}}, false},
    {"K", {1, 0, {0, 0, 0, 0, 1}}, false},
    {"W", {1, 0, {1, 2, -3, 0, 0}}, true},
    {"rad", {1, 0, {0, 0, 0, 1, 0}}, true},
    {"deg", {pi / 180, 0, {0, 0, 0, 1, 0}}, false},
    {"\u00b0", {pi / 180, 0, {0, 0, 0, 1, 0}}, false},
    {"%", {1, -2, {0, 0, 0, 0, 0}}, false},
};

struct Prefix
{
  std::string_view name;
  double decimals;
};

constexpr Prefix prefixes[] = {
    {"P", 15}, {"T", 12}, {"G", 9},   {"M", 6},   {"k", 3},       {"h", 2},
    {"da", 1}, {"d", -1}, {"c", -2},  {"m", -3},  {"\u00b5", -6}, {"\u03bc", -6},
    {"u", -6}, {"n", -9}, {"p", -12}, {"f", -15},
};

std::optional<Unit> find_unit(std::string_view name)
{
  for (const NamedUnit &known : named_units)
    if (known.name == name)
      return known.unit;
  for (const Prefix &prefix : prefixes)
    if (name.substr(0, prefix.name.size()) == prefix.name)
      for (const NamedUnit &known : named_units)
        if (known.takes_prefix && known.name == name.substr(prefix.name.size())) {
          Unit unit = known.unit;
          unit.decimals += prefix.decimals;
          return unit;
        }
  return {};
}

Unit power(Unit unit, double exponent)
{
  unit.number = std::pow(unit.number, exponent);
  unit.decimals *= exponent;
  for (double &e : unit.exponents)
    e *= exponent;
  return unit;
}

Unit product(Unit a, const Unit &b)
{
  a.number *= b.number;
  a.decimals += b.decimals;
  for (std::size_t k = 0; k < a.exponents.size(); ++k)
    a.exponents[k] += b.exponents[k];
  return a;
}

/// value * number * 10^decimals. Powers up to 10^22 are exact, hence one rounding for each factor.
double apply(const Unit &unit, double value)
{
  value *= unit.number;
  const double whole = std::round(unit.decimals);
  double size = 1;
  for (int k = 0; k < std::min(std::abs(whole), 22.0); ++k)
    size *= 10;
  const double rest =
      std::pow(10.0, unit.decimals - std::copysign(std::min(std::abs(whole), 22.0), whole));
  value = whole < 0 ? value / size : value * size;
  return rest == 1 ? value : value * rest;
}

class UnitParser
{
public:
  explicit UnitParser(std::string_view text) : text_(text) {}

  Unit parse()
  {
    Unit unit = product_of_factors();
    if (!text_.empty())
      throw std::invalid_argument(fmt::format("unexpected \"{}\" in the unit", text_));
    return unit;
  }

private:
  Unit product_of_factors()
  {
    Unit unit = factor();
    while (true) {
      const bool blank = skip_blanks();
      if (text_.empty() || text_[0] == ')')
        return unit;
      if (take("/"))
        unit = product(unit, power(factor(), -1));
      else if (take("*") || take("\u00b7") || blank)
        unit = product(unit, factor());
      else
        throw std::invalid_argument(fmt::format("unexpected \"{}\" in the unit", text_));
    }
  }

  Unit factor()
  {
    skip_blanks();
    Unit unit;
    if (take("sqrt("))
      unit = power(bracket(), 0.5);
    else if (take("("))
      unit = bracket();
    else if (!take("1")) {
      const std::string_view name = take_name();
      const std::optional<Unit> known = find_unit(name);
      if (!known)
        throw std::invalid_argument(name.empty() ? std::string("a unit is missing")
                                                 : fmt::format("there is no unit \"{}\"", name));
      unit = *known;
    }
    if (take("\u00b2"))
      return power(unit, 2);
    if (take("\u00b3"))
      return power(unit, 3);
    if (take("^"))
      return power(unit, exponent());
    return unit;
  }

  Unit bracket()
  {
    const Unit unit = product_of_factors();
    if (!take(")"))
      throw std::invalid_argument("a bracket in the unit is not closed");
    return unit;
  }

  double exponent()
  {
    const bool bracketed = take("(");
    double e = exponent_number();
    if (bracketed && take("/"))
      e /= exponent_number();
    if (bracketed && !take(")"))
      throw std::invalid_argument("a bracket in the unit is not closed");
    if (!(std::abs(e) <= 12))
      throw std::invalid_argument("the power of a unit is out of range");
    return e;
  }

  double exponent_number()
  {
    double e = 0;
    const auto [end, error] =
        std::from_chars(text_.data(), text_.data() + text_.size(), e, std::chars_format::fixed);
    if (error != std::errc())
      throw std::invalid_argument("a power needs a number, such as m^2 or m^0.5");
    text_.remove_prefix(end - text_.data());
    return e;
  }

  std::string_view take_name()
  {
    std::size_t end = 0;
    while (end < text_.size() && std::string_view("*/^() \t").find(text_[end]) == text_.npos &&
           text_.substr(end, 2) != "\u00b2" && text_.substr(end, 2) != "\u00b3" &&
           text_.substr(end, 2) != "\u00b7")
      ++end;
    const std::string_view name = text_.substr(0, end);
    text_.remove_prefix(end);
    return name;
  }

  bool take(std::string_view token)
  {
    if (text_.substr(0, token.size()) != token)
      return false;
    text_.remove_prefix(token.size());
    return true;
  }

  bool skip_blanks()
  {
    bool any = false;
    while (take(" ") || take("\t"))
      any = true;
    return any;
  }

  std::string_view text_;
};

std::string_view trimmed(std::string_view text)
{
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t'))
    text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t'))
    text.remove_suffix(1);
  return text;
}

/// Length of the decimal number at the start; 0 when there is none.
std::size_t number_length(std::string_view s)
{
  std::size_t k = 0;
  const auto digits = [&] {
    const std::size_t start = k;
    while (k < s.size() && s[k] >= '0' && s[k] <= '9')
      ++k;
    return k - start;
  };
  if (k < s.size() && (s[k] == '-' || s[k] == '+'))
    ++k;
  std::size_t n = digits();
  if (k < s.size() && s[k] == '.') {
    ++k;
    n += digits();
  }
  if (n == 0)
    return 0;
  if (k < s.size() && (s[k] == 'e' || s[k] == 'E')) {
    const std::size_t mantissa_end = k++;
    if (k < s.size() && (s[k] == '-' || s[k] == '+'))
      ++k;
    if (digits() == 0)
      k = mantissa_end;
  }
  return k;
}
} // namespace

bool read_number(std::string_view token, double &value)
{
  if (!token.empty() && token[0] == '+')
    token.remove_prefix(1);
  if (token.empty() || number_length(token) != token.size() || token[0] == '+')
    return false;
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (error == std::errc::result_out_of_range) {
    value = 0;
    return token.find("e-") != token.npos || token.find("E-") != token.npos;
  }
  return error == std::errc() && std::isfinite(value);
}

Quantity parse_unit(std::string_view text)
{
  const Unit unit = UnitParser(trimmed(text)).parse();
  return {apply(unit, 1), unit.exponents};
}

Quantity parse_quantity(std::string_view text)
{
  text = trimmed(text);
  const std::size_t length = number_length(text);
  if (length == 0)
    throw std::invalid_argument("it does not start with a finite number");
  Quantity quantity;
  if (!read_number(text.substr(0, length), quantity.value))
    throw std::invalid_argument("the number is too large");
  const std::string_view rest = trimmed(text.substr(length));
  if (rest.empty())
    return quantity;
  if (rest[0] == ',')
    throw std::invalid_argument("decimals are written with a point");
  const Unit unit = UnitParser(rest).parse();
  quantity.value = apply(unit, quantity.value);
  quantity.exponents = unit.exponents;
  if (!std::isfinite(quantity.value))
    throw std::invalid_argument("the number is too large");
  return quantity;
}

bool same_dimension(const UnitExponents &a, const UnitExponents &b)
{
  // Powers are short decimals and fractions: their sums are right to rounding.
  for (std::size_t k = 0; k < a.size(); ++k)
    if (std::abs(a[k] - b[k]) > 1e-9)
      return false;
  return true;
}

std::string to_string(const UnitExponents &exponents)
{
  static constexpr std::string_view names[] = {"kg", "m", "s", "rad", "K"};
  static_assert(std::size(names) == std::tuple_size_v<UnitExponents>);
  std::string above, below;
  int n_below = 0;
  for (std::size_t k = 0; k < exponents.size(); ++k) {
    const double e = exponents[k];
    if (std::abs(e) < 1e-9)
      continue;
    std::string &side = e > 0 ? above : below;
    n_below += e < 0;
    if (!side.empty())
      side += "*";
    side += names[k];
    if (std::abs(std::abs(e) - 1) > 1e-9)
      side += fmt::format("^{:.6g}", std::abs(e));
  }
  if (above.empty())
    above = "1";
  if (below.empty())
    return above;
  return above + "/" + (n_below > 1 ? "(" + below + ")" : below);
}
} // namespace ligament::core
