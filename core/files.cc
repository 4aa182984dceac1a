#include "core/files.h"

#include "core/check.h"

#include <fmt/core.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace ligament::core
{
namespace
{
constexpr std::size_t buffer_size = 1 << 16;

/// What a disk took before it was full would be half a line: the file ends where the last write
/// that succeeded ended.
void take_back(int descriptor, std::size_t bytes)
{
  const off_t end = ::lseek(descriptor, 0, SEEK_END) - off_t(bytes);
  if (bytes > 0 && end >= 0 && ::ftruncate(descriptor, end) == 0)
    ::lseek(descriptor, end, SEEK_SET);
}

/// A device or pipe must be written in place: renaming over it would destroy it.
bool exists_but_is_not_a_file(const std::string &path)
{
  struct stat status;
  return ::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode);
}
} // namespace

OutputFile::OutputFile(std::string path, Mode mode) : path_(std::move(path)), written_path_(path_)
{
  renames_ = mode == Mode::replace && !exists_but_is_not_a_file(path_);
  if (renames_)
    written_path_ += ".part";
  const int flags = O_WRONLY | O_CREAT | O_CLOEXEC | (mode == Mode::append ? O_APPEND : O_TRUNC);
  descriptor_ = ::open(written_path_.c_str(), flags, 0666);
  if (descriptor_ < 0)
    fail("open");
}

OutputFile::~OutputFile()
{
  if (descriptor_ < 0)
    return;
  if (!renames_)
    try {
      flush();
    } catch (const EnvironmentError &) {
    }
  ::close(descriptor_);
  if (renames_)
    ::unlink(written_path_.c_str());
}

void OutputFile::fail(const std::string &action) const
{
  throw EnvironmentError(
      fmt::format("cannot {} {}: {}", action, written_path_, std::strerror(errno)));
}

void OutputFile::write(std::string_view text)
{
  if (buffer_.size() + text.size() > buffer_size)
    flush();
  if (text.size() > buffer_size)
    write_through(text);
  else
    buffer_ += text;
}

void OutputFile::write_through(std::string_view text)
{
  const std::size_t size = text.size();
  while (!text.empty()) {
    const ssize_t n = ::write(descriptor_, text.data(), text.size());
    if (n < 0 && errno == EINTR)
      continue;
    if (n < 0) {
      const int error = errno;
      take_back(descriptor_, size - text.size());
      errno = error;
      fail("write");
    }
    text.remove_prefix(n);
  }
}

void OutputFile::flush()
{
  write_through(buffer_); // kept when that fails: there may be room later
  buffer_.clear();
}

void OutputFile::sync()
{
  flush();
  // Some file systems report a full disk only here. Devices cannot be synchronised (EINVAL).
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS)
    fail("write");
}

void OutputFile::commit()
{
  sync();
  if (::close(std::exchange(descriptor_, -1)) != 0)
    fail("close");
  if (renames_ && std::rename(written_path_.c_str(), path_.c_str()) != 0)
    fail("rename");
}

void write_file(const std::string &path, std::string_view text)
{
  OutputFile file(path);
  file.write(text);
  file.commit();
}

void cut_file(const std::string &path, std::int64_t bytes)
{
  struct stat status;
  require(::stat(path.c_str(), &status) == 0,
          fmt::format("cannot read {}: {}", path, std::strerror(errno)));
  require(status.st_size >= bytes, fmt::format("{} has {} bytes where {} were written", path,
                                               std::int64_t(status.st_size), bytes));
  if (status.st_size > bytes && ::truncate(path.c_str(), bytes) != 0)
    throw EnvironmentError(fmt::format("cannot cut {}: {}", path, std::strerror(errno)));
}

std::string read_file(const std::string &path)
{
  const auto fail = [&] {
    throw EnvironmentError(fmt::format("cannot read {}: {}", path, std::strerror(errno)));
  };
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0)
    fail();
  std::string text;
  char block[buffer_size];
  ssize_t n;
  while ((n = ::read(descriptor, block, sizeof(block))) > 0)
    text.append(block, n);
  const int error = errno;
  ::close(descriptor);
  errno = error;
  if (n < 0)
    fail();
  return text;
}
} // namespace ligament::core
