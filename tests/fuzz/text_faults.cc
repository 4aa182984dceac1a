#include "tests/fuzz/text_faults.h"

#include <algorithm>

namespace ligament::fuzz
{
namespace
{
std::vector<std::string> lines_of(const std::string &text)
{
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

/// First byte and length of a field of the line, drawn among all of them.
std::pair<std::size_t, std::size_t> field_of(Draw &draw, const std::string &line,
                                             const std::string &separators)
{
  std::vector<std::pair<std::size_t, std::size_t>> fields;
  for (std::size_t begin = line.find_first_not_of(separators); begin != line.npos;) {
    const std::size_t end = std::min(line.find_first_of(separators, begin), line.size());
    fields.emplace_back(begin, end - begin);
    begin = line.find_first_not_of(separators, end);
  }
  return fields.empty() ? std::pair<std::size_t, std::size_t>(0, 0) : draw.of(fields);
}

void spoil_field(Draw &draw, std::string &line, const std::string &separators)
{
  const auto [begin, size] = field_of(draw, line, separators);
  const std::string field = line.substr(begin, size);
  switch (draw.below(5)) {
  case 0:
    line.erase(begin, size + 1);
    break;
  case 1:
    line.insert(begin, field + separators[0]);
    break;
  case 2:
    line.replace(begin, size, odd_word(draw));
    break;
  case 3: // off by a little: counts and indices
    if (!field.empty() && field.find_first_not_of("-0123456789") == field.npos && field.size() < 9)
      line.replace(begin, size, std::to_string(std::atoi(field.c_str()) + draw.between(-2, 2)));
    break;
  default:
    line.replace(begin, size, odd_number(draw));
  }
}
} // namespace

std::string with_wrong_line(Draw &draw, const std::string &text, const std::string &separators)
{
  std::vector<std::string> lines = lines_of(text);
  if (lines.empty())
    return text;
  const std::size_t k = draw.below(lines.size());
  switch (draw.below(8)) {
  case 0:
    lines.erase(lines.begin() + k);
    break;
  case 1:
    lines.insert(lines.begin() + k, std::string(lines[k]));
    break;
  case 2:
    std::swap(lines[k], lines[draw.below(lines.size())]);
    break;
  case 3:
    lines[k].resize(draw.below(lines[k].size() + 1));
    break;
  default:
    spoil_field(draw, lines[k], separators);
  }
  std::string joined;
  for (const std::string &line : lines)
    joined += line + "\n";
  return joined;
}

std::string with_wrong_bytes(Draw &draw, const std::string &text)
{
  static const std::vector<std::string> marks = {"{", "}",  "[",  "]",  "\"",  ":",      ",",
                                                 "#", "$",  "\n", " ",  "-",   "\\",     "\\u12",
                                                 "/", "/*", "*/", "//", "\\x", "\\ud800"};
  if (text.empty())
    return text;
  std::string wrong = text;
  const std::size_t at = draw.below(wrong.size());
  const std::size_t length = 1 + draw.below(8);
  switch (draw.below(6)) {
  case 0:
    wrong.resize(at);
    break;
  case 1:
    wrong.erase(at, length);
    break;
  case 2:
    wrong.insert(at, wrong.substr(at, length));
    break;
  case 3:
    wrong[at] = char(draw.below(256));
    break;
  case 4:
    wrong.replace(at, 1, draw.of(marks));
    break;
  default:
    wrong.insert(at, wrong_bytes(draw));
  }
  return wrong;
}
} // namespace ligament::fuzz
