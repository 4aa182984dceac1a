#include "src/drawing/shown_field.h"

#include "core/check.h"
#include "core/parameters/spelling.h"

#include <algorithm>
#include <array>

namespace ligament::program
{
namespace
{
constexpr std::array<const char *, 3> vector_names = {"x", "y", "z"};
constexpr std::array<const char *, 6> tensor_names = {"xx", "yy", "zz", "xy", "yz", "xz"};
} // namespace

std::string ShownField::label() const
{
  std::string text = word;
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::string ShownField::unit() const
{
  for (const FieldInfo &info : field_table())
    if (info.name == field)
      return info.unit;
  return "1";
}

std::vector<std::string> shown_field_words(int dimension)
{
  std::vector<std::string> words;
  const auto add = [&](const std::string &word) { words.push_back(word); };
  for (const FieldInfo &info : field_table()) {
    if (info.kind != Field::Kind::tensor && info.name != "global_id")
      add(info.name);
    if (info.kind == Field::Kind::vector)
      for (int c = 0; c < dimension; ++c)
        add(info.name + "_" + vector_names[c]);
    if (info.kind == Field::Kind::tensor)
      for (int c = 0; c < (dimension == 2 ? 4 : 6); ++c)
        add(info.name + "_" + tensor_names[c]);
  }
  return words;
}

ShownField shown_field(const std::string &word, int dimension)
{
  const auto words = shown_field_words(dimension);
  if (std::find(words.begin(), words.end(), word) == words.end())
    throw core::InputError("there is no field \"" + word + "\"" + core::did_you_mean(word, words) +
                           "; there are " + core::listed(words, "and"));
  for (const FieldInfo &info : field_table()) {
    const int n = info.kind == Field::Kind::vector ? 3 : info.kind == Field::Kind::tensor ? 6 : 0;
    if (word == info.name)
      return {word, word, -1};
    for (int c = 0; c < n; ++c)
      if (word == info.name + "_" + (n == 3 ? vector_names[c] : tensor_names[c]))
        return {word, info.name, c};
  }
  throw core::InputError("there is no field '" + word + "'");
}
} // namespace ligament::program
