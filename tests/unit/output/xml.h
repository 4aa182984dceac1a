// Just enough XML to tell whether a file is well formed and to find its elements again.
#pragma once

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace ligament::tests
{
struct Element
{
  std::string name;
  std::map<std::string, std::string> attributes;
  std::string text; // up to the first child or the end
  std::string parent;
};

/// All elements in order; throws when tags do not match.
inline std::vector<Element> parse_xml(const std::string &text)
{
  std::vector<Element> elements;
  std::vector<std::string> open;
  const auto fail = [](const std::string &reason) { throw std::runtime_error("XML: " + reason); };
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) {
    const std::size_t end = text.find('>', at);
    if (end == std::string::npos)
      fail("tag without end");
    std::string tag = text.substr(at + 1, end - at - 1);
    at = end + 1;
    if (tag[0] == '?' || tag[0] == '!')
      continue;
    if (tag[0] == '/') {
      if (open.empty() || open.back() != tag.substr(1))
        fail("unexpected </" + tag.substr(1) + ">");
      open.pop_back();
      continue;
    }
    const bool closed = tag.back() == '/';
    if (closed)
      tag.pop_back();
    Element element;
    std::size_t next = tag.find_first_of(" \n");
    element.name = tag.substr(0, next);
    while (next != std::string::npos) {
      const std::size_t name = tag.find_first_not_of(" \n", next);
      if (name == std::string::npos)
        break;
      const std::size_t quote = tag.find("=\"", name);
      const std::size_t close = quote == std::string::npos ? quote : tag.find('"', quote + 2);
      if (close == std::string::npos)
        fail("attribute without value in <" + tag + ">");
      const std::string key = tag.substr(name, quote - name);
      if (!element.attributes.emplace(key, tag.substr(quote + 2, close - quote - 2)).second)
        fail("attribute twice: " + key);
      next = close + 1;
    }
    element.parent = open.empty() ? "" : open.back();
    element.text = text.substr(at, text.find('<', at) - at);
    if (!closed)
      open.push_back(element.name);
    elements.push_back(element);
  }
  if (!open.empty())
    fail("no end of <" + open.back() + ">");
  return elements;
}
} // namespace ligament::tests
