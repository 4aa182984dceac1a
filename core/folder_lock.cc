#include "core/folder_lock.h"

#include "core/check.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace ligament::core
{
namespace
{
std::string lock_file(const std::string &folder)
{
  return folder + "/lock";
}

int open_file(const std::string &file)
{
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0)
    throw EnvironmentError(fmt::format("cannot open {}: {}", file, std::strerror(errno)));
  return descriptor;
}

/// Whether the descriptor is still what the name means: the one who held the lock may have removed
/// the file, or moved the folder, before it let go.
bool is_in_place(int descriptor, const std::string &file)
{
  struct stat opened, named;
  return ::fstat(descriptor, &opened) == 0 && ::stat(file.c_str(), &named) == 0 &&
         opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

/// Who wrote its number into the file; 0 when that cannot be read.
int holder(int descriptor)
{
  char text[32] = {};
  const ssize_t n = ::pread(descriptor, text, sizeof(text) - 1, 0);
  return n > 0 ? std::atoi(text) : 0;
}
} // namespace

FolderLock::FolderLock(const std::string &folder, const std::string &work)
    : file_(lock_file(folder))
{
  do {
    if (descriptor_ >= 0)
      ::close(descriptor_);
    descriptor_ = open_file(file_);
    // File systems without locks (ENOLCK, EOPNOTSUPP, ..) do not keep anyone from computing.
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      const int id = holder(descriptor_);
      ::close(std::exchange(descriptor_, -1));
      throw EnvironmentError(
          fmt::format("{}: another {} is under way in this folder{}; wait for its end, or give "
                      "another folder with --output",
                      folder, work, id > 0 ? fmt::format(" (process {})", id) : ""));
    }
  } while (!is_in_place(descriptor_, file_));
  const std::string id = fmt::format("{}\n", ::getpid());
  // For the message above alone: on a full disk it does without.
  if (::ftruncate(descriptor_, 0) != 0 || ::pwrite(descriptor_, id.data(), id.size(), 0) < 0)
    return;
}

FolderLock::~FolderLock()
{
  if (is_in_place(descriptor_, file_))
    ::unlink(file_.c_str());
  ::close(descriptor_);
}

bool FolderLock::is_held(const std::string &folder)
{
  const int descriptor = ::open(lock_file(folder).c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0)
    return false;
  const bool held = ::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(descriptor);
  return held;
}
} // namespace ligament::core
