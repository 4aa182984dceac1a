// What the checks of a scene find: errors and warnings, placed at the keys they are about.
#pragma once

#include "core/json.h"

#include <initializer_list>
#include <set>
#include <string>

namespace ligament::program
{
class Findings
{
public:
  /// `errors` holds what reading found; both lists grow.
  Findings(const core::JsonValue &json, std::vector<core::Diagnostic> &errors,
           std::vector<core::Diagnostic> &warnings);

  /// The key's value follows from others: from now on it counts as given.
  void derive(const std::string &key) { derived_.insert(key); }

  /// True when the file or an override gives the key a value other than null.
  bool written(const std::string &key) const;
  /// Likewise, or when the value follows from others.
  bool given(const std::string &key) const { return derived_.count(key) || written(key); }
  /// True when nothing wrong was found at these keys, above or below them: their values may be
  /// used.
  bool sound(std::initializer_list<std::string> keys) const;
  /// Both.
  bool sound_and_given(std::initializer_list<std::string> keys) const;

  void error(const std::string &key, const std::string &message, const std::string &reason,
             const std::string &remedy);
  void warning(const std::string &key, const std::string &message, const std::string &reason,
               const std::string &remedy);
  /// A warning that the key, if it is given and sound, means nothing beside the others.
  void unused(const std::string &key, const std::string &reason,
              const std::string &remedy = "remove it");

private:
  const core::JsonValue &json_;
  std::set<std::string> derived_;
  std::vector<core::Diagnostic> &errors_, &warnings_;
};
} // namespace ligament::program
