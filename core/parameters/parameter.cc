#include "core/parameters/parameter.h"

#include "core/parameters/parameter_section.h"
#include "core/parameters/spelling.h"

#include <fmt/format.h>

#include <cmath>
#include <sstream>

namespace ligament::core
{
Parameter &Parameter::in(const std::string &name)
{
  unit_name = name;
  unit = parse_unit(name).exponents;
  return *this;
}

bool Band::holds(double value) const
{
  const double size = std::abs(value);
  return size == 0 || (size >= low && size <= high);
}

bool Band::is_within_reason(double value) const
{
  return Band{low / reason, high * reason, {}}.holds(value);
}

Parameter &Parameter::usually(double low, double high, const std::string &units)
{
  band = Band{low, high, {}};
  std::istringstream words(units);
  for (std::string word; words >> word;)
    band->units.push_back(word);
  return *this;
}

Parameter &Parameter::one_of(std::vector<std::string> words)
{
  kind = Kind::choice;
  choices = std::move(words);
  return *this;
}

Parameter &Parameter::word(const std::string &word, double value)
{
  words[word] = value;
  return *this;
}

Parameter &Parameter::null_means(double value)
{
  null_value = value;
  return *this;
}

Parameter &Parameter::required()
{
  necessity = Necessity::required;
  return *this;
}

Parameter &Parameter::required_unless(const std::string &when)
{
  necessity = Necessity::conditional;
  condition = "unless " + when;
  return *this;
}

Parameter &Parameter::only_in(int dimension)
{
  only_dimension = dimension;
  return *this;
}

Parameter &Parameter::as_rotation()
{
  kind = Kind::rotation;
  return *this;
}

Parameter &Parameter::set(std::optional<Bound> &bound, double value, bool open)
{
  bound = Bound{value, open};
  return *this;
}

bool Parameter::must_be_given(int dimension) const
{
  if (only_dimension != 0 && dimension != only_dimension)
    return false;
  const bool always_present = kind == Kind::section && absent_word.empty();
  return necessity == Necessity::required || (always_present && section->must_be_given(dimension));
}

std::string Parameter::range() const
{
  std::string text;
  if (lower)
    text = fmt::format("{} {}", lower->open ? "above" : "at least", lower->value);
  if (upper)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", upper->open ? "below" : "at most",
                        upper->value);
  return text;
}

std::string Parameter::usual_range() const
{
  if (!band)
    return "";
  return band->low == 0 ? fmt::format("up to {:g}", band->high)
                        : fmt::format("{:g} to {:g}", band->low, band->high);
}

std::string Parameter::type(int dimension) const
{
  const std::string unit_text = unit_name.empty() || unit_name == "1" ? "" : " in " + unit_name;
  const std::string count = dimension == 0 ? "2 or 3" : std::to_string(dimension);
  const std::string components =
      "a list of " + count +
      (null_value || std::holds_alternative<PartialPoint *>(target) ? " numbers or nulls"
                                                                    : " numbers") +
      unit_text;
  switch (kind) {
  case Kind::ignored:
    return "anything";
  case Kind::number: {
    std::string text = "a number" + unit_text;
    for (const auto &word : words)
      text += " or \"" + word.first + "\"";
    return text;
  }
  case Kind::integer:
    return "a whole number";
  case Kind::boolean:
    return "true or false";
  case Kind::string:
    return "a string";
  case Kind::choice:
    return listed(choices);
  case Kind::vector:
    return components;
  case Kind::rotation:
    return dimension == 2   ? "a number" + unit_text
           : dimension == 3 ? components
                            : "a number (2D) or a list of 3 numbers (3D)" + unit_text;
  case Kind::points:
    return "a list of points, each " + components;
  case Kind::table:
    return "a list of pairs [a number" + unit_text + ", a number]";
  case Kind::members:
    return "an object of keys and values";
  case Kind::section: {
    std::vector<std::string> words;
    if (!section->shorthand().empty())
      words = section->find(section->shorthand())->choices;
    if (!absent_word.empty())
      words.push_back(absent_word);
    return "an object {..}" + (words.empty() ? "" : " or " + listed(words));
  }
  case Kind::list:
    return "a list of objects [{..}, ..]";
  }
  return "";
}
} // namespace ligament::core
