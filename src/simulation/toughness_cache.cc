#include "src/simulation/toughness_cache.h"

#include "core/check.h"
#include "core/files.h"

#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <unistd.h>

namespace ligament::program
{
namespace
{
/// FNV-1a: the same on every machine.
std::uint64_t hash(const std::string &text)
{
  std::uint64_t h = 14695981039346656037u;
  for (const char c : text)
    h = (h ^ std::uint8_t(c)) * 1099511628211u;
  return h;
}

/// The number in a file of key and number, a line each.
std::optional<double> read(const std::string &path, const std::string &key)
try {
  std::istringstream text(core::read_file(path));
  std::string first;
  double value = 0;
  std::getline(text, first);
  text >> value;
  if (first == key && text && std::isfinite(value) && value > 0)
    return value;
  return {};
} catch (const core::EnvironmentError &) {
  return {};
}
} // namespace

std::string ToughnessCache::default_folder()
{
  const auto variable = [](const char *name) {
    const char *const value = std::getenv(name);
    return std::string(value ? value : "");
  };
  const std::string cache = variable("XDG_CACHE_HOME"), home = variable("HOME");
  if (!cache.empty())
    return cache + "/ligament/toughness";
  return home.empty() ? "" : home + "/.cache/ligament/toughness";
}

std::string ToughnessCache::path(const std::string &key) const
{
  return fmt::format("{}/{:016x}", folder_, hash(key));
}

void ToughnessCache::keep(const std::string &key, double value) const
try {
  std::error_code failed; // then it is found again next time
  std::filesystem::create_directories(folder_, failed);
  static std::atomic<int> number = 0;
  const std::string own = fmt::format("{}.{}-{}", path(key), ::getpid(), ++number);
  core::write_file(own, fmt::format("{}\n{}\n", key, value));
  std::filesystem::rename(own, path(key), failed);
  if (failed)
    std::filesystem::remove(own, failed);
} catch (const core::EnvironmentError &) {
}

double ToughnessCache::factor(const std::string &key, const std::function<double()> &find) const
{
  if (folder_.empty())
    return find();
  if (const auto kept = read(path(key), key))
    return *kept;
  const double value = find();
  keep(key, value);
  return value;
}
} // namespace ligament::program
