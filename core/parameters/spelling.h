// Did you mean: the known word nearest to a misspelt one.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ligament::core
{
/// Fewest insertions, deletions, replacements and swaps of neighbours from a to b.
int edit_distance(std::string_view a, std::string_view b);

/// The nearest of the words when it is near enough to be meant (a third of the letters, at least
/// one); else the only one that begins with the same part before an underscore; else nothing.
std::string nearest_word(std::string_view word, const std::vector<std::string> &known);

/// ", did you mean "x"?" or nothing.
std::string did_you_mean(std::string_view word, const std::vector<std::string> &known);

/// "a", "b" or "c", or with another last conjunction.
std::string listed(const std::vector<std::string> &words, const std::string &conjunction = "or");
} // namespace ligament::core
