#include "core/parameters/spelling.h"

#include <algorithm>

namespace ligament::core
{
int edit_distance(std::string_view a, std::string_view b)
{
  // Rows k-2, k-1 and k of the table of distances between the starts of a and b.
  std::vector<int> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j)
    last[j] = int(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = int(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

namespace
{
/// "overlap_width" and "overlap_cells" are relatives.
std::string only_relative(std::string_view word, const std::vector<std::string> &known)
{
  const std::size_t length = word.find('_') + 1; // 0 without an underscore
  if (length < 5)
    return "";
  const auto is_relative = [&](const std::string &candidate) {
    return candidate.compare(0, length, word, 0, length) == 0;
  };
  const auto first = std::find_if(known.begin(), known.end(), is_relative);
  const bool only = std::count_if(known.begin(), known.end(), is_relative) == 1;
  return only ? *first : "";
}
} // namespace

std::string nearest_word(std::string_view word, const std::vector<std::string> &known)
{
  std::string nearest;
  int best = std::max(1, int(word.size()) / 3) + 1;
  for (const std::string &candidate : known) {
    // A word of which only the beginning was typed is near, however long the rest.
    const bool beginning = word.size() >= 3 && candidate.compare(0, word.size(), word) == 0;
    const int distance = beginning ? 1 : edit_distance(word, candidate);
    if (distance < best) {
      best = distance;
      nearest = candidate;
    }
  }
  return nearest.empty() ? only_relative(word, known) : nearest;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string> &known)
{
  const std::string nearest = nearest_word(word, known);
  return nearest.empty() ? "" : ", did you mean \"" + nearest + "\"?";
}

std::string listed(const std::vector<std::string> &words, const std::string &conjunction)
{
  std::string text;
  for (std::size_t k = 0; k < words.size(); ++k)
    text += (k == 0                  ? std::string()
             : k + 1 == words.size() ? " " + conjunction + " "
                                     : ", ") +
            ("\"" + words[k] + "\"");
  return text;
}
} // namespace ligament::core
