// Factors between toughness and strength that earlier runs have found: one small file for each.
#pragma once

#include <functional>
#include <string>

namespace ligament::program
{
class ToughnessCache
{
public:
  /// $XDG_CACHE_HOME/ligament/toughness, else the same in $HOME/.cache; empty without either.
  static std::string default_folder();

  /// An empty folder keeps nothing.
  explicit ToughnessCache(std::string folder = default_folder()) : folder_(std::move(folder)) {}

  /// The number above 0 that is kept under this key (one line); else what find() answers, which is
  /// kept from now on. A folder that cannot be read or written costs time, nothing else; runs may
  /// share it, since files appear whole.
  double factor(const std::string &key, const std::function<double()> &find) const;

  /// The file of a key.
  std::string path(const std::string &key) const;

private:
  void keep(const std::string &key, double value) const;

  std::string folder_;
};
} // namespace ligament::program
