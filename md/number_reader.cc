#include "md/number_reader.h"

#include "core/check.h"
#include "core/files.h"
#include "core/units.h"

#include <fmt/format.h>

#include <cmath>

namespace ligament::md
{
namespace
{
bool is_blank(char c)
{
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}
} // namespace

NumberReader::NumberReader(const std::string &path) : path_(path), text_(core::read_file(path))
{
}

char NumberReader::next_character()
{
  const char c = text_[next_++];
  if (c == '\n') {
    ++line_;
    column_ = 1;
  } else
    ++column_;
  return c;
}

void NumberReader::skip_line()
{
  word_line_ = line_;
  word_column_ = column_;
  require(next_ < text_.size(), "the file ends in its head: it is cut short; get a whole one");
  while (next_ < text_.size() && next_character() != '\n') {
  }
}

std::string_view NumberReader::word(const std::string &what)
{
  while (next_ < text_.size() && is_blank(text_[next_]))
    next_character();
  word_line_ = line_;
  word_column_ = column_;
  if (next_ == text_.size())
    fail("the file ends where " + what + " should stand: it is cut short; get a whole one");
  const std::size_t begin = next_;
  while (next_ < text_.size() && !is_blank(text_[next_]))
    next_character();
  return std::string_view(text_).substr(begin, next_ - begin);
}

double NumberReader::number(const std::string &what)
{
  std::string token(word(what));
  const std::string written = token;
  for (char &c : token)
    if (c == 'd' || c == 'D')
      c = 'e';
  double value = 0;
  if (!core::read_number(token, value) || !std::isfinite(value))
    fail(fmt::format("\"{}\" is no finite number: {} should stand here; mend the file", written,
                     what));
  return value;
}

int NumberReader::count(const std::string &what, int least)
{
  const double value = number(what);
  if (value != std::floor(value) || value < least || value > 1e8)
    fail(fmt::format("{} is {}: it must be a whole number from {} on; mend the file", what, value,
                     least));
  return int(value);
}

std::vector<double> NumberReader::numbers(const std::string &what, int n)
{
  std::vector<double> values(n);
  for (int k = 0; k < n; ++k)
    values[k] = number(fmt::format("number {} of {} of {}", k + 1, n, what));
  return values;
}

void NumberReader::expect_end()
{
  while (next_ < text_.size() && is_blank(text_[next_]))
    next_character();
  word_line_ = line_;
  word_column_ = column_;
  require(next_ == text_.size(), "the file goes on behind its last table: numbers and counts in "
                                 "its head do not fit; check the head");
}

void NumberReader::fail(const std::string &text) const
{
  throw core::InputError(fmt::format("{}:{}:{}: {}", path_, word_line_, word_column_, text));
}
} // namespace ligament::md
