#include "core/log.h"

#include "core/check.h"
#include "core/tell.h"

#include <fmt/chrono.h>

namespace ligament::core
{
Log::Log(const std::string &path, std::FILE *echo)
    : echo_(echo), start_(std::chrono::steady_clock::now())
{
  if (!path.empty())
    file_.emplace(path, OutputFile::Mode::append);
}

void Log::info(const std::string &message)
{
  line("info", message);
}

void Log::warning(const std::string &message)
{
  warnings_.push_back(message);
  line("warning", message);
  tell(echo_, "warning: " + message + "\n");
}

void Log::line(const char *level, const std::string &message)
{
  if (!file_)
    return;
  const double elapsed =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const std::string now = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  try {
    file_->write(fmt::format("{} {:10.3f} s {:<7} {}\n", now, elapsed, level, message));
    file_->flush();
  } catch (const EnvironmentError &error) {
    file_.reset();
    tell(echo_, fmt::format("warning: {}; the log ends here\n", error.what()));
  }
}
} // namespace ligament::core
