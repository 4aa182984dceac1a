#include "core/keyed_error.h"

#include <algorithm>
#include <cctype>
#include <utility>

namespace ligament::core
{
namespace
{
std::string sentence(const KeyedError &e)
{
  std::string text = e.key + (e.key.empty() ? "" : ": ") + e.message;
  if (!e.reason.empty())
    text += ": " + e.reason;
  if (!e.remedy.empty())
    text += "; " + e.remedy;
  return text;
}

/// Length of the key of a scene at the start of the text, such as /coupling/overlap_cells.
std::size_t key_length(const std::string &text, std::size_t begin)
{
  const auto is_part = [](char c) {
    return c == '/' || c == '_' || std::islower(static_cast<unsigned char>(c)) ||
           std::isdigit(static_cast<unsigned char>(c));
  };
  std::size_t end = begin;
  while (end < text.size() && is_part(text[end]))
    ++end;
  return end - begin;
}

/// Paths of files go on with other characters, or with a line: /tmp/Cu.eam, /tmp/table:4:3.
bool ends_word(const std::string &text, std::size_t end)
{
  if (end == text.size() || std::string(" ,;)").find(text[end]) != std::string::npos)
    return true;
  return text[end] == ':' && (end + 1 == text.size() || text[end + 1] == ' ');
}

/// The first key of a scene in the text, a word of its own; empty: none.
std::string named_key(const std::string &text)
{
  for (std::size_t at = text.find('/'); at != text.npos; at = text.find('/', at + 1)) {
    const std::size_t length = key_length(text, at);
    const bool begins_word = at == 0 || text[at - 1] == ' ';
    if (begins_word && length > 1 && ends_word(text, at + length))
      return text.substr(at, length);
  }
  return "";
}

/// Cuts the text before the last separator; what stood behind it.
std::string cut_off(std::string &text, const std::string &separator, std::size_t at)
{
  if (at == text.npos)
    return "";
  const std::string tail = text.substr(at + separator.size());
  text.resize(at);
  return tail;
}
} // namespace

KeyedError::KeyedError(std::string key_, std::string message_, std::string reason_,
                       std::string remedy_)
    : InputError(""), key(std::move(key_)), message(std::move(message_)),
      reason(std::move(reason_)), remedy(std::move(remedy_))
{
  static_cast<InputError &>(*this) = InputError(sentence(*this));
}

KeyedError keyed(const std::string &text, const std::string &default_key,
                 const std::string &default_remedy)
{
  std::string message = text;
  std::string key = named_key(text);
  if (text.rfind(key + ": ", 0) == 0 && !key.empty())
    message = text.substr(key.size() + 2);
  else if (key.empty())
    key = default_key;
  std::string remedy = cut_off(message, "; ", message.rfind("; "));
  std::string reason = cut_off(message, ": ", message.find(": "));
  if (remedy.empty())
    std::swap(remedy, reason);
  return {key, message, reason, remedy.empty() ? default_remedy : remedy};
}
} // namespace ligament::core
