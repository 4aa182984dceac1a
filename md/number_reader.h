// Reads a text file word by word and tells where what is wrong.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ligament::md
{
/// All errors are core::InputError, "file:line:column: finding: reason; remedy".
class NumberReader
{
public:
  /// Throws core::EnvironmentError where there is no such file.
  explicit NumberReader(const std::string &path);

  void skip_line();

  /// The next word; `what` was expected there.
  std::string_view word(const std::string &what);
  /// The next word as a finite number; Fortran's exponents (1.0D-3) are understood.
  double number(const std::string &what);
  /// As a whole number from `least` on.
  int count(const std::string &what, int least);
  /// So many numbers.
  std::vector<double> numbers(const std::string &what, int n);
  /// Only blanks may follow.
  void expect_end();

  /// About the word read last.
  [[noreturn]] void fail(const std::string &text) const;
  void require(bool condition, const std::string &text) const
  {
    if (!condition)
      fail(text);
  }

private:
  char next_character();

  std::string path_, text_;
  std::size_t next_ = 0;
  int line_ = 1, column_ = 1;           // of text_[next_]
  int word_line_ = 1, word_column_ = 1; // of the last word
};
} // namespace ligament::md
