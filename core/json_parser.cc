#include "core/json.h"
#include "core/units.h"

#include <charconv>
#include <cstdint>
#include <system_error>

namespace ligament::core
{
namespace
{
using Kind = JsonValue::Kind;

/// Thrown at the first mistake of syntax; stays inside this file.
struct SyntaxError
{
  Place place;
  std::string message, remedy;
};

class JsonParser
{
public:
  JsonParser(std::string_view text, const std::string &origin, std::vector<Diagnostic> &errors)
      : text_(text), origin_(origin), errors_(errors)
  {
    if (text_.substr(0, 3) == "\xEF\xBB\xBF") // byte order mark
      text_.remove_prefix(3);
  }

  JsonValue parse()
  {
    skip_blanks();
    JsonValue root = value("");
    skip_blanks();
    if (!at_end())
      fail("text after the end of the scene", "remove it, or check the brackets before it");
    return root;
  }

private:
  static constexpr int max_depth = 64;

  bool at_end() const { return next_ == text_.size(); }
  char peek() const { return at_end() ? '\0' : text_[next_]; }
  Place here() const { return {origin_, line_, column_}; }

  char take()
  {
    const char c = text_[next_++];
    if (c == '\n') {
      ++line_;
      column_ = 1;
    } else if ((static_cast<unsigned char>(c) & 0xC0) != 0x80) // count characters, not bytes
      ++column_;
    return c;
  }

  [[noreturn]] void fail(const std::string &message, const std::string &remedy) const
  {
    throw SyntaxError{here(), message, remedy};
  }

  std::string shown() const
  {
    if (at_end())
      return "the end of the text";
    std::size_t end = next_ + 1;
    while (end < text_.size() && end - next_ < 20 && is_word(text_[end - 1]) && is_word(text_[end]))
      ++end;
    return "\"" + std::string(text_.substr(next_, end - next_)) + "\"";
  }

  static bool is_word(char c)
  {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '.' || c == '-' || c == '+' || (c & 0x80) != 0;
  }

  void skip_blanks()
  {
    while (!at_end()) {
      const char c = peek();
      if (c == ' ' || c == '\t' || c == '\n' || c == '\r')
        take();
      else if (c == '/' && next_ + 1 < text_.size() && text_[next_ + 1] == '/')
        while (!at_end() && peek() != '\n')
          take();
      else if (c == '/' && next_ + 1 < text_.size() && text_[next_ + 1] == '*')
        skip_block_comment();
      else
        return;
    }
  }

  void skip_block_comment()
  {
    const Place start = here();
    take();
    take();
    while (text_.substr(next_, 2) != "*/") {
      if (at_end())
        throw SyntaxError{start, "this comment does not end", "close it with */"};
      take();
    }
    take();
    take();
  }

  JsonValue value(const std::string &path)
  {
    if (++depth_ > max_depth)
      fail("more than 64 levels of brackets", "a scene needs five at most");
    JsonValue v;
    v.place = here();
    const char c = peek();
    if (c == '{')
      object(v, path);
    else if (c == '[')
      array(v, path);
    else if (c == '"') {
      v.kind = Kind::string;
      v.text = string();
    } else if (c == '-' || (c >= '0' && c <= '9'))
      number(v);
    else
      literal(v);
    --depth_;
    return v;
  }

  void object(JsonValue &v, const std::string &path)
  {
    v.kind = Kind::object;
    take();
    skip_blanks();
    while (peek() != '}') {
      if (!v.members.empty())
        separator('}', v.place);
      if (peek() != '"')
        fail("expected a key in double quotes, found " + shown(), "write \"key\": value");
      JsonMember member;
      member.place = here();
      member.key = string();
      skip_blanks();
      if (peek() != ':')
        fail("expected a colon after the key \"" + member.key + "\", found " + shown(),
             "write \"" + member.key + "\": value");
      take();
      skip_blanks();
      const std::string key_path = path + "/" + member.key;
      member.value = value(key_path);
      if (const JsonMember *first = v.find(member.key))
        errors_.push_back({member.place, key_path,
                           "duplicate key \"" + member.key + "\" in " + (path.empty() ? "/" : path),
                           "it was given before at " + to_string(first->place),
                           "remove one of them"});
      else
        v.members.push_back(std::move(member));
      skip_blanks();
    }
    take();
  }

  void array(JsonValue &v, const std::string &path)
  {
    v.kind = Kind::array;
    take();
    skip_blanks();
    while (peek() != ']') {
      if (!v.elements.empty())
        separator(']', v.place);
      v.elements.push_back(value(path + "/" + std::to_string(v.elements.size())));
      skip_blanks();
    }
    take();
  }

  /// The comma between two members or elements.
  void separator(char close, const Place &opened)
  {
    if (at_end())
      throw SyntaxError{opened, "this bracket is never closed",
                        std::string("close it with ") + close};
    if (peek() != ',')
      fail(std::string("expected a comma or ") + close + ", found " + shown(),
           "put a comma between the values");
    const Place comma = here();
    take();
    skip_blanks();
    if (peek() == close)
      throw SyntaxError{comma, std::string("a comma before ") + close, "remove the comma"};
  }

  std::string string()
  {
    const Place start = here();
    take();
    std::string s;
    while (true) {
      if (at_end() || peek() == '\n')
        throw SyntaxError{start, "this string does not end on its line", "close it with \""};
      if (static_cast<unsigned char>(peek()) < 0x20)
        fail("control character in a string", "write it as \\t or \\u00XX");
      if (peek() == '"')
        break;
      if (peek() == '\\')
        escape(s);
      else
        character(s);
    }
    take();
    return s;
  }

  /// One character of UTF-8, checked: the texts are written into JSON again.
  void character(std::string &s)
  {
    const auto lead = static_cast<unsigned char>(peek());
    const int more = lead < 0x80                   ? 0
                     : lead >= 0xC2 && lead < 0xE0 ? 1
                     : lead >= 0xE0 && lead < 0xF0 ? 2
                     : lead >= 0xF0 && lead < 0xF5 ? 3
                                                   : -1;
    bool valid = more >= 0 && next_ + more < text_.size();
    for (int k = 1; valid && k <= more; ++k)
      valid = (static_cast<unsigned char>(text_[next_ + k]) & 0xC0) == 0x80;
    if (valid && more >= 2) {
      // Overlong forms, surrogates and numbers beyond U+10FFFF start with these second bytes.
      const auto second = static_cast<unsigned char>(text_[next_ + 1]);
      valid = !(lead == 0xE0 && second < 0xA0) && !(lead == 0xED && second > 0x9F) &&
              !(lead == 0xF0 && second < 0x90) && !(lead == 0xF4 && second > 0x8F);
    }
    if (!valid)
      fail("a byte that is not UTF-8", "save the file in UTF-8");
    for (int k = 0; k <= more; ++k)
      s += take();
  }

  void escape(std::string &s)
  {
    static constexpr std::string_view codes = "\"\\/bfnrt", meanings = "\"\\/\b\f\n\r\t";
    const Place start = here();
    take();
    const char c = peek();
    if (const auto k = codes.find(c); !at_end() && k != codes.npos) {
      take();
      s += meanings[k];
      return;
    }
    if (c != 'u')
      throw SyntaxError{start, "unknown escape in a string", "write \\\\ for a backslash"};
    std::uint32_t code = hex4(start);
    if (code >= 0xD800 && code < 0xDC00) {
      if (peek() != '\\')
        throw SyntaxError{start, "half of a character pair", "write both halves, or the character"};
      take();
      const std::uint32_t low = hex4(start);
      if (low < 0xDC00 || low > 0xDFFF)
        throw SyntaxError{start, "half of a character pair", "write both halves, or the character"};
      code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
    } else if (code >= 0xDC00 && code <= 0xDFFF)
      throw SyntaxError{start, "half of a character pair", "write both halves, or the character"};
    append_utf8(s, code);
  }

  std::uint32_t hex4(const Place &start)
  {
    std::uint32_t code = 0;
    const std::string_view digits = text_.substr(next_, 5);
    const auto [end, error] = std::from_chars(digits.data() + (digits.empty() ? 0 : 1),
                                              digits.data() + digits.size(), code, 16);
    if (digits.size() < 5 || digits[0] != 'u' || error != std::errc() || end != digits.data() + 5)
      throw SyntaxError{start, "an escape needs four hexadecimal digits", "write \\u00e4"};
    for (int k = 0; k < 5; ++k)
      take();
    return code;
  }

  static void append_utf8(std::string &s, std::uint32_t code)
  {
    const auto tail = [&](int shift) { s += static_cast<char>(0x80 | ((code >> shift) & 0x3F)); };
    if (code < 0x80)
      s += static_cast<char>(code);
    else if (code < 0x800) {
      s += static_cast<char>(0xC0 | (code >> 6));
      tail(0);
    } else if (code < 0x10000) {
      s += static_cast<char>(0xE0 | (code >> 12));
      tail(6);
      tail(0);
    } else {
      s += static_cast<char>(0xF0 | (code >> 18));
      tail(12);
      tail(6);
      tail(0);
    }
  }

  void number(JsonValue &v)
  {
    std::size_t end = next_;
    while (end < text_.size() && is_word(text_[end]))
      ++end;
    const std::string_view token = text_.substr(next_, end - next_);
    if (!is_json_number(token))
      fail("\"" + std::string(token) + "\" is not a number",
           "write 0.5 or 5e-1; a value with a unit stands in double quotes, such as \"12.5 mm\"");
    if (!read_number(token, v.number))
      fail("\"" + std::string(token) + "\" is too large for a number", "check the exponent");
    v.kind = Kind::number;
    v.text = token;
    while (next_ < end)
      take();
  }

  /// -? digits [. digits] [e digits], without leading zeros.
  static bool is_json_number(std::string_view s)
  {
    std::size_t k = 0;
    const auto digits = [&] {
      const std::size_t start = k;
      while (k < s.size() && s[k] >= '0' && s[k] <= '9')
        ++k;
      return k - start;
    };
    if (k < s.size() && s[k] == '-')
      ++k;
    const bool zero = k < s.size() && s[k] == '0';
    const std::size_t whole = digits();
    if (whole == 0 || (zero && whole > 1))
      return false;
    if (k < s.size() && s[k] == '.') {
      ++k;
      if (digits() == 0)
        return false;
    }
    if (k < s.size() && (s[k] == 'e' || s[k] == 'E')) {
      ++k;
      if (k < s.size() && (s[k] == '+' || s[k] == '-'))
        ++k;
      if (digits() == 0)
        return false;
    }
    return k == s.size();
  }

  void literal(JsonValue &v)
  {
    std::size_t end = next_;
    while (end < text_.size() && is_word(text_[end]))
      ++end;
    const std::string token(text_.substr(next_, end - next_));
    if (token == "true" || token == "false") {
      v.kind = Kind::boolean;
      v.boolean = token == "true";
    } else if (token == "null")
      v.kind = Kind::null;
    else if (token == "nan" || token == "NaN" || token == "inf" || token == "Infinity" ||
             token == "infinity")
      fail("\"" + token + "\" is not a finite number", "give a finite number");
    else if (token.empty())
      fail("expected a value, found " + shown(), "write a number, a string, [..] or {..}");
    else
      fail("expected a value, found \"" + token + "\"", "put words into double quotes");
    while (next_ < end)
      take();
  }

  std::string_view text_;
  std::string origin_;
  std::vector<Diagnostic> &errors_;
  std::size_t next_ = 0;
  int line_ = 1, column_ = 1, depth_ = 0;
};
} // namespace

JsonValue parse_json(std::string_view text, const std::string &origin,
                     std::vector<Diagnostic> &errors)
{
  try {
    return JsonParser(text, origin, errors).parse();
  } catch (const SyntaxError &error) {
    errors.push_back({error.place, "", error.message, "the text is not JSON", error.remedy});
    return {};
  }
}
} // namespace ligament::core
