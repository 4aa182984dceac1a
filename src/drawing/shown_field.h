// Which quantity colours a picture, chosen by a word of the user.
#pragma once

#include "src/output/fields.h"

#include <string>
#include <vector>

namespace ligament::program
{
/// What colours a picture: a field of the table, or one component of it.
struct ShownField
{
  std::string word = "stress_yy";
  std::string field = "stress";
  int component = 1; // -1: of a scalar; the length of a vector

  /// "stress yy".
  std::string label() const;
  std::string unit() const;
};

/// The words that choose one: "equivalent_stress", "velocity", "velocity_x", "stress_xx", ...
std::vector<std::string> shown_field_words(int dimension);
/// InputError for a word that is none of them, with those there are.
ShownField shown_field(const std::string &word, int dimension);
} // namespace ligament::program
