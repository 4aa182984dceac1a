#include "core/disk_reserve.h"

#include "core/check.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

namespace ligament::core
{
namespace
{
std::string reserve_of(const std::string &file)
{
  return file + ".reserve";
}
} // namespace

DiskReserve::DiskReserve(const std::string &for_file, std::size_t bytes) : for_file_(for_file)
{
  const std::string path = reserve_of(for_file);
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  const int error = descriptor < 0 ? errno : ::posix_fallocate(descriptor, 0, off_t(bytes));
  if (descriptor >= 0)
    ::close(descriptor);
  if (error == 0)
    return;
  release_reserve(for_file);
  // File systems that reserve nothing, and limits on the size of a file, leave us without.
  if (error == ENOSPC || error == EDQUOT)
    throw EnvironmentError(
        fmt::format("no room for {}, {} bytes at most: {}", for_file, bytes, std::strerror(error)));
}

DiskReserve::~DiskReserve()
{
  release_reserve(for_file_);
}

bool release_reserve(const std::string &for_file)
{
  return ::unlink(reserve_of(for_file).c_str()) == 0;
}
} // namespace ligament::core
