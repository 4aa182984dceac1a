#include "tests/fuzz/draw.h"

#include <cmath>

namespace ligament::fuzz
{
double Draw::spread(double low, double high)
{
  return low * std::pow(high / low, fraction());
}

std::string odd_number(Draw &draw)
{
  static const std::vector<std::string> numbers = {"0",
                                                   "-0",
                                                   "-1",
                                                   "1",
                                                   "2",
                                                   "3",
                                                   "64",
                                                   "-7",
                                                   "2147483647",
                                                   "2147483648",
                                                   "-2147483648",
                                                   "4294967296",
                                                   "9223372036854775807",
                                                   "9223372036854775808",
                                                   "1e308",
                                                   "-1e308",
                                                   "1.7976931348623157e308",
                                                   "1e309",
                                                   "-1e400",
                                                   "5e-324",
                                                   "1e-320",
                                                   "1e-400",
                                                   "2.2250738585072014e-308",
                                                   "0.1",
                                                   "1e16",
                                                   "123456789",
                                                   "nan",
                                                   "NaN",
                                                   "inf",
                                                   "-inf",
                                                   "Infinity",
                                                   "-nan(1)",
                                                   "0x10",
                                                   "010",
                                                   "1,5",
                                                   "1.",
                                                   ".5",
                                                   "+1",
                                                   "1e",
                                                   "1e+",
                                                   "--1",
                                                   "1 2",
                                                   "1_000",
                                                   "1e9",
                                                   "1000000000",
                                                   "-1000000000",
                                                   "1e-9"};
  return draw.of(numbers);
}

std::string odd_word(Draw &draw)
{
  static const std::vector<std::string> words = {
      "",         " ",          "none",        "all",          "never",
      "left",     "x",          "a b",         "\"",           "\\",
      "{}",       "[",          "a/b",         "~0~1",         "null",
      "true",     "../x",       "/",           "%s%n",         "{:f}",
      "\xC3\xA4", "\n",         "\t",          "\x1b[31m",     "1 m",
      "1 m^",     "1 m/",       "sqrt(",       "1e5 GPa",      "1 parsec",
      "m^1e99",   "5 m^-1e308", "1 ((((((((m", "\xE2\x82\xAC", "\xF0\x9F\x92\xA5"};
  return draw.once_in(20) ? std::string(1 + draw.below(3000), 'a') : draw.of(words);
}

std::string wrong_bytes(Draw &draw)
{
  static const std::vector<std::string> bytes = {
      "\x80", "\xBF",     "\xC3",     "\xC0\xAF",         "\xE0\x80\xAF", "\xED\xA0\x80",
      "\xFF", "\xFE\xFF", "\xF5\x80", "\xF4\x90\x80\x80", "\xE2\x82",     std::string(1, '\0'),
      "\x01", "\x7F",     "\r",       "\xEF\xBB\xBF"};
  return draw.of(bytes);
}
} // namespace ligament::fuzz
