// The run's log: one line per message with date, seconds since the start and level.
#pragma once

#include "core/files.h"

#include <fmt/core.h>

#include <chrono>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace ligament::core
{
/// Passed in, never global. Lines reach the file at once. Without a path nothing is written to
/// disk; warnings also go to `echo` when that is given.
class Log
{
public:
  explicit Log(const std::string &path = "", std::FILE *echo = nullptr);

  void info(const std::string &message);
  void warning(const std::string &message);
  /// All warnings so far, in their order.
  const std::vector<std::string> &warnings() const { return warnings_; }
  /// For a run that goes on: those of before in place of what its set-up has said again.
  void set_warnings(std::vector<std::string> warnings) { warnings_ = std::move(warnings); }

  template <typename... Args>
  void info(fmt::format_string<Args...> format, Args &&...args)
  {
    info(fmt::format(format, std::forward<Args>(args)...));
  }
  template <typename... Args>
  void warning(fmt::format_string<Args...> format, Args &&...args)
  {
    warning(fmt::format(format, std::forward<Args>(args)...));
  }

private:
  void line(const char *level, const std::string &message);

  std::optional<OutputFile> file_;
  std::FILE *echo_;
  std::vector<std::string> warnings_;
  std::chrono::steady_clock::time_point start_;
};
} // namespace ligament::core
